#include "radioslam/io/ros/ros_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/io/ros/uwb_message.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

using RangeEnds = std::pair<std::string, std::string>;

/// The parts of a text between any of these characters.
std::vector<std::string> words_of(const std::string& text, const char* separators) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (std::string_view(separators).find(c) != std::string_view::npos)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

/// Finds the ends of topics.
class EndFinder {
 public:
  explicit EndFinder(const RosRangeRequest& request) : request_(request) {}

  std::optional<RangeEnds> find(const RosTopic& topic) const {
    if (const auto stated = request_.ends.find(topic.name); stated != request_.ends.end())
      return stated->second;
    const std::string text = topic.name + '/' + topic.frame;
    for (const char* separators : {"/", "/-.:", "/-.:_"})
      if (const auto named = named_in(words_of(text, separators)); named.size() == 2)
        return RangeEnds{named[0], named[1]};
    for (const char* separators : {"/", "/-.:", "/-.:_"})
      if (const auto named = named_in(words_of(text, separators));
          named.size() == 1 && !request_.own.empty() && named[0] != request_.own)
        return RangeEnds{request_.own, named[0]};
    return std::nullopt;
  }

 private:
  /// The robots and anchors that the words name, each once.
  std::vector<std::string> named_in(const std::vector<std::string>& words) const {
    std::vector<std::string> found;
    for (const std::string& word : words) {
      const auto radio = request_.names.find(word);
      const std::string& id = radio == request_.names.end() ? word : radio->second;
      const bool is_known = radio != request_.names.end() || request_.robots.contains(id);
      if (is_known && std::find(found.begin(), found.end(), id) == found.end()) found.push_back(id);
    }
    return found;
  }

  const RosRangeRequest& request_;
};

/// The definition of a topic whose messages say which radios their ranges are between.
std::optional<RosDefinition> uwb_definition_of(const RosTopic& topic) {
  if (topic.type == kRangeType || topic.definition.empty()) return std::nullopt;
  auto definition = RosDefinition::parse(topic.type, topic.definition);
  return definition && has_uwb_ranges(*definition) ? std::move(definition) : std::nullopt;
}

/// Reads the ranges of topics with known ends.
class RangeReader {
 public:
  RangeReader(const RosTopicIndex& index, const RosRangeRequest& request) : index_(index), request_(request) {
    const EndFinder finder(request);
    for (const RosTopic& topic : index.topics) {
      if (auto definition = uwb_definition_of(topic)) {
        uwb_.emplace(topic.name, std::move(*definition));
        continue;
      }
      if (topic.type != kRangeType) continue;
      if (const auto ends = finder.find(topic))
        ends_[topic.name] = *ends;
      else
        left_.push_back(topic);
    }
  }

  bool has_topics() const { return !ends_.empty() || !uwb_.empty(); }
  bool reads(const RosChannel& channel) const {
    return ends_.contains(channel.topic) || uwb_.contains(channel.topic);
  }

  void take(const RosMessage& message) {
    if (!reads(message.channel)) return;
    RosMessage timed = message;
    timed.stamp = {message.stamp.ns - index_.recording_delay.ns};
    if (const auto uwb = uwb_.find(message.channel.topic); uwb != uwb_.end())
      take_uwb(uwb->second, timed);
    else
      take_range(timed);
  }

  RosRanges finish(const std::string& source) {
    std::stable_sort(result_.ranges.begin(), result_.ranges.end(),
                     [](const RosRange& a, const RosRange& b) { return a.stamp < b.stamp; });
    for (const auto& [topic, ends] : ends_) result_.topics.insert(topic);
    for (const auto& [topic, definition] : uwb_) result_.topics.insert(topic);
    for (const auto& [radio, count] : without_owner_)
      result_.warnings.push_back(source + ": " + std::to_string(count) + " ranges of radio " +
                                 (radio.empty() ? "'' (the recording's robot is not known)" : radio) +
                                 " are left out; --name " + radio + "=ID says whose it is");
    if (unreadable_.count() > 0) result_.warnings.push_back(unreadable_.warning(source, "range"));
    warn(source, without_stamp_, "ranges have no stamp, unlike others of their topic, and are left out");
    warn(source, invalid_, "ranges that are not positive or outside of their own limits are left out");
    warn(source, without_sigma_, "ranges state no sigma; 0.1 m is assumed");
    if (!left_.empty())
      result_.warnings.push_back(source +
                                 ": between whom these topics have ranges is unknown, and they are left "
                                 "out: " +
                                 list_of_topics(left_) +
                                 "; --name RADIO=ID says whose a radio in their names is, --ranges "
                                 "TOPIC=ID,ID both ends");
    return std::move(result_);
  }

 private:
  void take_range(const RosMessage& message) {
    const auto range = unreadable_.attempt([&] { return read_ros_range(message); });
    if (!range) return;
    if (range->header.stamp == Stamp{} && index_.find(message.channel.topic)->has_stamps) {
      ++without_stamp_;
      return;
    }
    if (!range->is_valid) return void(++invalid_);
    const RangeEnds& ends = ends_.at(message.channel.topic);
    add({time_of(message, range->header), ends.first, ends.second, range->range_m, 0}, range->sigma_m);
  }

  void take_uwb(const RosDefinition& definition, const RosMessage& message) {
    const auto read = unreadable_.attempt([&] { return read_uwb_message(definition, message); });
    if (!read) return;
    const Stamp stamp = read->stamp == Stamp{} ? message.stamp : read->stamp;
    for (const UwbRange& range : read->ranges) {
      if (!(range.range_m > 0) || !std::isfinite(range.range_m)) {
        ++invalid_;
        continue;
      }
      const auto from = owner_of(range.from), to = owner_of(range.to);
      if (!from || !to)
        ++without_owner_[from ? range.to : range.from];
      else if (*from != *to)
        add({stamp, *from, *to, range.range_m, 0}, range.sigma_m);
    }
  }

  /// The robot or anchor that has a radio; without a radio, the one that made the recording.
  std::optional<std::string> owner_of(const std::string& radio) const {
    if (radio.empty()) return request_.own.empty() ? std::nullopt : std::optional(request_.own);
    if (const auto named = request_.names.find(radio); named != request_.names.end()) return named->second;
    return request_.robots.contains(radio) ? std::optional(radio) : std::nullopt;
  }

  void add(RosRange range, const std::optional<double>& sigma_m) {
    if (!sigma_m) ++without_sigma_;
    range.sigma_m = sigma_m.value_or(kUnknownRangeSigma_m);
    result_.ranges.push_back(std::move(range));
  }

  void warn(const std::string& source, std::size_t count, const char* what) {
    if (count > 0) result_.warnings.push_back(source + ": " + std::to_string(count) + ' ' + what);
  }

  const RosTopicIndex& index_;
  const RosRangeRequest& request_;
  std::map<std::string, RangeEnds> ends_;             ///< by topic
  std::map<std::string, RosDefinition> uwb_;          ///< by topic, of UWB drivers
  std::map<std::string, std::size_t> without_owner_;  ///< ranges, by radio
  std::vector<RosTopic> left_;
  SkippedRecords unreadable_;
  std::size_t invalid_ = 0, without_stamp_ = 0, without_sigma_ = 0;
  RosRanges result_;
};

}  // namespace

bool may_have_ranges(const RosTopic& topic) {
  return topic.type == kRangeType || uwb_definition_of(topic).has_value();
}

RosRanges read_ros_ranges(const std::filesystem::path& source, const RosTopicIndex& index,
                          const RosRangeRequest& request) {
  RangeReader reader(index, request);
  if (reader.has_topics())
    visit_recording(source, {[&](const RosChannel& channel) { return reader.reads(channel); },
                             [&](const RosMessage& message) { reader.take(message); }});
  return reader.finish(source.string());
}

}  // namespace radioslam
