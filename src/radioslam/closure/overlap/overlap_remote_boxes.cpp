#include "radioslam/closure/overlap/overlap_remote_boxes.hpp"

#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"

namespace radioslam {
namespace {

std::vector<std::uint32_t> boxes_of(const auto& waiting) {
  std::vector<std::uint32_t> boxes;
  for (const auto& [box, _] : waiting) boxes.push_back(box);
  return boxes;
}

}  // namespace

std::string write_request(const BoxRequest& request) {
  OverlapFieldWriter out;
  for (const auto* list : {&request.open, &request.send}) {
    out(static_cast<std::uint32_t>(list->size()));
    for (const std::uint32_t box : *list) out(box);
  }
  return out.take();
}

std::optional<BoxRequest> read_request(std::string_view bytes) {
  OverlapFieldReader in(bytes);
  BoxRequest request;
  for (auto* list : {&request.open, &request.send})
    for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
      const std::uint32_t box = in.number();
      in.refuse_unless(list->empty() || list->back() < box);
      list->push_back(box);
    }
  if (!in.is_complete()) return std::nullopt;
  return request;
}

template <OverlapView View>
std::optional<BoxRequest> RemoteBoxes<View>::request() {
  if (has_roots_ && to_open_.empty() && to_send_.empty()) return std::nullopt;
  asks_roots_ = !has_roots_;
  asked_open_ = std::exchange(to_open_, {});
  asked_send_ = std::exchange(to_send_, {});
  return BoxRequest{boxes_of(asked_open_), boxes_of(asked_send_)};
}

template <OverlapView View>
auto RemoteBoxes<View>::read_box(std::uint32_t j, std::uint32_t begin, const View& view,
                                 OverlapFieldReader& in) const -> Box {
  Box box;
  visit_node(box.node, in);
  box.node.middle = box.node.begin + box.node.size() / 2;
  Record::visit(box.middle, in);
  in.refuse_unless(!boxes_.contains(j) && is_box(box.node, j, begin) && view.accepts(box.middle));
  return box;
}

template <OverlapView View>
bool RemoteBoxes<View>::receive_roots(OverlapFieldReader& in, const View& view) {
  std::map<std::uint32_t, Box> boxes;
  std::vector<Root> roots;
  std::uint32_t begin = 0;
  for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
    Root root;
    in(root.node), in(root.component);
    const Box box = read_box(root.node, begin, view, in);
    begin = box.node.end;
    in.refuse_unless(boxes.emplace(root.node, box).second);
    roots.push_back(root);
  }
  if (!in.is_complete()) return false;
  boxes_ = std::move(boxes);
  roots_ = std::move(roots);
  has_roots_ = true;
  asks_roots_ = false;
  return true;
}

template <OverlapView View>
bool RemoteBoxes<View>::receive_boxes(std::string_view content, const View& view, Waitings& opened) {
  OverlapFieldReader in(content);
  if (asks_roots_) return receive_roots(in, view);
  std::map<std::uint32_t, Box> boxes;
  for (const std::uint32_t j : boxes_of(asked_open_)) {
    const Node& J = node(j);
    std::uint32_t begin = J.begin;
    for (const std::uint32_t half : {j + 1, J.right}) {
      const Box box = read_box(half, begin, view, in);
      begin = box.node.end;
      in.refuse_unless(box.node.begin == (half == J.right ? J.middle : J.begin) &&
                       box.node.end == (half == J.right ? J.end : J.middle) &&
                       boxes.emplace(half, box).second);
    }
    if (!in.good()) return false;
  }
  if (asked_open_.empty() || !in.is_complete()) return false;
  boxes_.merge(boxes);
  opened = std::exchange(asked_open_, {});
  return true;
}

template <OverlapView View>
bool RemoteBoxes<View>::receive_poses(std::string_view content, const View& view, Waitings& sent) {
  OverlapFieldReader in(content);
  std::map<std::uint32_t, Record> poses;
  for (const auto& [j, _] : asked_send_) {
    const Node& J = node(j);
    poses.emplace(J.middle, middle(j));
    for (std::uint32_t l = J.begin; l < J.end && in.good(); ++l) {
      if (l == J.middle) continue;
      Record record;
      Record::visit(record, in);
      in.refuse_unless(view.accepts(record));
      poses.emplace(l, record);
    }
  }
  if (asked_send_.empty() || !in.is_complete()) return false;
  poses_.merge(poses);
  sent = std::exchange(asked_send_, {});
  return true;
}

template class RemoteBoxes<LinkView<SE2>>;
template class RemoteBoxes<LinkView<SE3>>;
template class RemoteBoxes<JointView<SE2>>;
template class RemoteBoxes<JointView<SE3>>;

}  // namespace radioslam
