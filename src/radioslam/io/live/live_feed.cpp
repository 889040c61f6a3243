#include "radioslam/io/live/live_feed.hpp"

#include <utility>

namespace radioslam {

bool LiveFeed::is_read() const {
  const std::lock_guard lock(mutex_);
  return readers_ > 0;
}

bool LiveFeed::needs_whole() const {
  const std::lock_guard lock(mutex_);
  return newcomers_ > 0;
}

void LiveFeed::publish(LiveText change, LiveText whole) {
  const std::lock_guard lock(mutex_);
  changes_.push_back(std::move(change));
  if (changes_.size() > kKept) {
    changes_.pop_front();
    ++first_;
  }
  if (whole) {
    whole_ = std::move(whole);
    whole_until_ = first_ + changes_.size();
  } else if (whole_until_ < first_) {
    whole_ = nullptr;
  }
  published_.notify_all();
}

void LiveFeed::end(LiveText last) {
  const std::lock_guard lock(mutex_);
  last_ = std::move(last);
  published_.notify_all();
}

LiveFeed::Reader::Reader(LiveFeed& feed) : feed_(feed) {
  const std::lock_guard lock(feed_.mutex_);
  ++feed_.readers_;
  ++feed_.newcomers_;
}

LiveFeed::Reader::~Reader() {
  const std::lock_guard lock(feed_.mutex_);
  --feed_.readers_;
  if (!has_whole_) --feed_.newcomers_;
}

/// Under the lock.
LiveText LiveFeed::Reader::ready() {
  if (has_whole_ && next_ < feed_.first_) {  // too late for what it has not read
    has_whole_ = false;
    ++feed_.newcomers_;
  }
  if (!has_whole_ && feed_.whole_ && feed_.whole_until_ >= feed_.first_) {
    has_whole_ = true;
    --feed_.newcomers_;
    next_ = feed_.whole_until_;
    return feed_.whole_;
  }
  if (has_whole_ && next_ < feed_.first_ + feed_.changes_.size())
    return feed_.changes_[next_++ - feed_.first_];
  if (!feed_.last_ || is_over_) return nullptr;
  is_over_ = true;
  return feed_.last_;
}

LiveText LiveFeed::Reader::next(std::chrono::milliseconds wait) {
  std::unique_lock lock(feed_.mutex_);
  LiveText text;
  feed_.published_.wait_for(lock, wait, [&] { return (text = ready()) != nullptr; });
  return text;
}

}  // namespace radioslam
