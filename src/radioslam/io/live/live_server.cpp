#include "radioslam/io/live/live_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kThreads = LiveServer::kMostReaders + 4;
constexpr std::size_t kMostWaiting = 16;  // connections
constexpr int kPatience_s = 2;            // with one that does not go on
constexpr milliseconds kWait{500}, kGrace{3000};

/// Threads for connections; whoever accepts more waits, and the system refuses them in the end.
class BoundedPool : public httplib::TaskQueue {
 public:
  BoundedPool() {
    for (std::size_t k = 0; k < kThreads; ++k) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> job) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return jobs_.size() < kMostWaiting || is_ending_; });
    jobs_.push_back(std::move(job));  // which closes its connection, at the end too
    changed_.notify_all();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
      changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      const auto job = std::move(jobs_.front());
      jobs_.pop_front();
      changed_.notify_all();
      lock.unlock();
      job();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::vector<std::thread> threads_;
  bool is_ending_ = false;
};

/// `host`: a Host header.
bool names_this_machine(const std::string& host) {
  if (host.starts_with('[')) return is_loopback(host.substr(1, host.find(']') - 1));
  return is_loopback(host.substr(0, host.find(':')));
}

void answer(httplib::Response& response, int status, const char* words) {
  response.status = status;
  response.set_content(std::string(words) + '\n', "text/plain");
}

void secure(httplib::Response& response) {
  response.set_header("Cache-Control", "no-store");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
}

std::string policy(const std::string& nonce) {
  return "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
         "'; connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

bool is_same_secret(const std::string& secret, const std::string& given) {
  std::size_t different = secret.size() ^ given.size();
  for (std::size_t k = 0; k < given.size(); ++k)
    different |= static_cast<unsigned>(given[k] ^ (secret.empty() ? '\0' : secret[k % secret.size()]));
  return different == 0;
}

struct LiveServer::State : std::enable_shared_from_this<LiveServer::State> {
  LiveServerSetup setup;
  std::shared_ptr<LiveFeed> feed;
  httplib::Server server;
  std::atomic<std::size_t> readers = 0;
  std::atomic<bool> is_ending = false;
  std::mutex mutex;
  std::condition_variable changed;
  bool has_ended = false;

  bool is_allowed(const httplib::Request& request) const {
    if (setup.token.empty()) return names_this_machine(request.get_header_value("Host"));
    constexpr std::string_view kBearer = "Bearer ";
    const std::string header = request.get_header_value("Authorization");
    const std::string given =
        header.starts_with(kBearer) ? header.substr(kBearer.size()) : request.get_param_value("token");
    return is_same_secret(setup.token, given);
  }

  /// Whether the request is refused.
  bool refuse(const httplib::Request& request, httplib::Response& response) const {
    secure(response);
    if (!is_allowed(request)) {
      if (!setup.token.empty()) response.set_header("WWW-Authenticate", "Bearer");
      answer(response, setup.token.empty() ? 403 : 401,
             setup.token.empty() ? "This page is for this machine alone." : "This page asks for its token.");
      return true;
    }
    if (request.method == "GET" || request.method == "HEAD") return false;
    response.set_header("Allow", "GET, HEAD");
    answer(response, 405, "This page is only read.");
    return true;
  }

  void serve_events(httplib::Response& response) {
    if (readers.fetch_add(1) >= kMostReaders) {
      --readers;
      response.set_header("Retry-After", "5");
      return answer(response, 503, "This page is open too often.");
    }
    const auto reader = std::make_shared<LiveFeed::Reader>(*feed);
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, reader](std::size_t, httplib::DataSink& sink) {
          const LiveText text = reader->next(kWait);
          if (text && !sink.write(text->data(), text->size())) return false;
          if (reader->is_over() || (is_ending && !text)) sink.done();
          return sink.is_writable();
        },
        [this](bool) { --readers; });
  }

  void route() {
    server.new_task_queue = [] { return new BoundedPool; };
    server.set_keep_alive_max_count(1);
    server.set_read_timeout(kPatience_s);
    server.set_write_timeout(kPatience_s);
    server.set_payload_max_length(0);
    server.set_socket_options([](socket_t socket) {  // not SO_REUSEPORT, with which two programs share one
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return refuse(request, response) ? httplib::Server::HandlerResponse::Handled
                                       : httplib::Server::HandlerResponse::Unhandled;
    });
    server.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      const std::string nonce = drawn_token();
      response.set_header("Content-Security-Policy", policy(nonce));
      response.set_content(setup.page(nonce), "text/html; charset=utf-8");
    });
    server.Get("/events",
               [this](const httplib::Request&, httplib::Response& response) { serve_events(response); });
    server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty()) answer(response, response.status, "There is nothing here.");
    });
  }

  void bind() {
    refuse_unusable(setup.address);
    const bool is_any = setup.address.port == 0;
    const int port = is_any ? server.bind_to_any_port(setup.address.host.c_str())
                     : server.bind_to_port(setup.address.host.c_str(), setup.address.port)
                         ? setup.address.port
                         : -1;
    if (port < 0) throw InputError("--live", 0, to_string(setup.address) + " cannot be used");
    setup.address.port = port;
  }
};

LiveServer::LiveServer(LiveServerSetup setup, std::shared_ptr<LiveFeed> feed)
    : state_(std::make_shared<State>()) {
  state_->setup = std::move(setup);
  state_->feed = std::move(feed);
  state_->route();
  state_->bind();
  std::thread([state = state_] {
    state->server.listen_after_bind();
    const std::lock_guard lock(state->mutex);
    state->has_ended = true;
    state->changed.notify_all();
  }).detach();
  while (!state_->server.is_running()) std::this_thread::sleep_for(milliseconds(1));  // stop() asks for it
}

/// A connection that sends a byte every now and then is not waited for.
LiveServer::~LiveServer() {
  state_->is_ending = true;
  state_->server.stop();
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_for(lock, kGrace, [this] { return state_->has_ended; });
}

const LiveAddress& LiveServer::address() const { return state_->setup.address; }

}  // namespace radioslam
