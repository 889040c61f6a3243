// Serves one page and the feed of its state by HTTP: GET / is the page, GET /events the feed as server-sent
// events, GET anything else is not there.
//
// Where the address is not this machine's alone, every request needs the token (?token=... or "Authorization:
// Bearer ..."). Where it is, requests must name this machine, so that no page of another site can read it by
// a name that it points here. At most kMostReaders read the feed at a time, and few connections wait. Nothing
// of a request is repeated in an answer.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "radioslam/io/live/live_address.hpp"
#include "radioslam/io/live/live_feed.hpp"

namespace radioslam {

struct LiveServerSetup {
  LiveAddress address;
  std::string token = {};  ///< empty: none is asked for
  /// The page, with this nonce in its style and script elements.
  std::function<std::string(const std::string& nonce)> page;
};

class LiveServer {
 public:
  static constexpr std::size_t kMostReaders = 8;

  /// Refuses what refuse_unusable() refuses.
  LiveServer(LiveServerSetup setup, std::shared_ptr<LiveFeed> feed);
  /// Ends all connections within a few seconds, whatever the others do.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// With the port that it has.
  const LiveAddress& address() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Whether two texts are the same; the time depends on the length of the second one alone.
bool is_same_secret(const std::string& secret, const std::string& given);

}  // namespace radioslam
