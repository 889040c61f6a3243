#include "radioslam/cli/agent/live_page.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "radioslam/report/live/live_page.hpp"

namespace radioslam::cli {
namespace {

constexpr std::chrono::seconds kPeriod{1};
constexpr std::size_t kSeldom = 10;  // periods, while nobody reads

LiveText as_event(const PageData& data) {
  return std::make_shared<const std::string>(
      "data: " + data.dump(-1, ' ', false, PageData::error_handler_t::replace) + "\n\n");
}

LiveServerSetup server_of(const LivePageSetup& setup) {
  return {setup.address, setup.token, [robot = setup.robot, dimension = setup.dimension](const auto& nonce) {
            return live_page_of(robot, dimension, nonce);
          }};
}

}  // namespace

LivePage::LivePage(LivePageSetup setup, const RunParams& params)
    : setup_(std::move(setup)),
      server_(server_of(setup_), feed_),
      live_(params),
      thread_([this] { run(); }) {}

LivePage::~LivePage() { end(); }

void LivePage::end() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_ending_, true)) return;
    changed_.notify_all();
  }
  thread_.join();
  const LiveText whole = as_event(changes_.whole());  // for who opens it only now
  feed_->publish(whole, whole);
  feed_->end(std::make_shared<const std::string>("event: end\ndata: {}\n\n"));
}

void LivePage::show(const Agent& agent, const TeamRun& run, const TeamTraffic& sent,
                    const TeamTraffic& received, Stamp now) {
  due_ = SteadyClock::now() + kPeriod;
  AgentView view = viewer_.view(agent, run, sent, received, now);
  view.team.start = setup_.start;
  view.team.rate = setup_.rate;
  const std::lock_guard lock(mutex_);
  if (next_)  // nobody has taken it, but its clouds come only once
    view.clouds.insert(view.clouds.begin(), std::make_move_iterator(next_->clouds.begin()),
                       std::make_move_iterator(next_->clouds.end()));
  next_ = std::move(view);
  changed_.notify_all();
}

void LivePage::run() {
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_ending_ || next_; });
    if (!next_) return;
    if (!feed_->is_read() && !is_ending_ && ++unread_ % kSeldom != 1) {
      changed_.wait_for(lock, kPeriod, [this] { return is_ending_; });
      continue;
    }
    AgentView view = *std::exchange(next_, std::nullopt);
    lock.unlock();
    publish(std::move(view));
  }
}

void LivePage::publish(AgentView view) {
  const LiveText change = as_event(changes_.next(live_.next(std::move(view))));
  feed_->publish(change, feed_->needs_whole() ? as_event(changes_.whole()) : nullptr);
}

}  // namespace radioslam::cli
