// Texts that one thread publishes and others wait for: changes of a state, one after the other, and now and
// then the whole of it, for readers that have nothing or that fell behind. Bounded: the last kKept changes.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace radioslam {

using LiveText = std::shared_ptr<const std::string>;

class LiveFeed {
 public:
  static constexpr std::size_t kKept = 8;

  /// Whether anybody reads, and whether somebody waits for the whole.
  bool is_read() const;
  bool needs_whole() const;
  /// The state's next change; `whole`: the state with it, which may be null if nobody waits for it.
  void publish(LiveText change, LiveText whole);
  /// The last text, for all; no other comes.
  void end(LiveText last);

  /// One that reads; the feed must outlive it.
  class Reader {
   public:
    explicit Reader(LiveFeed& feed);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    /// What is next, or nothing by then: first the whole, then the changes since.
    LiveText next(std::chrono::milliseconds wait);
    /// After the last text.
    bool is_over() const { return is_over_; }

   private:
    LiveText ready();

    LiveFeed& feed_;
    std::uint64_t next_ = 0;  ///< number of a change
    bool has_whole_ = false, is_over_ = false;
  };

 private:
  mutable std::mutex mutex_;
  std::condition_variable published_;
  std::deque<LiveText> changes_;
  std::uint64_t first_ = 0;  ///< number of the first change that is kept
  LiveText whole_, last_;
  std::uint64_t whole_until_ = 0;  ///< number of the first change that it does not have
  std::size_t readers_ = 0, newcomers_ = 0;
};

}  // namespace radioslam
