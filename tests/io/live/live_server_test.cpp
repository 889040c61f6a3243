#include "radioslam/io/live/live_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>
#include <utility>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

LiveText text(const std::string& words) { return std::make_shared<const std::string>(words); }

struct Served {
  explicit Served(const std::string& token = "")
      : server({{"127.0.0.1", 0}, token, [](const std::string& nonce) { return "page " + nonce; }}, feed),
        client("127.0.0.1", server.address().port) {}

  std::shared_ptr<LiveFeed> feed = std::make_shared<LiveFeed>();
  LiveServer server;
  httplib::Client client;
};

int status(const httplib::Result& result) { return result ? result->status : -1; }

TEST(LiveServer, ServesThePageAndNothingElse) {
  Served served;
  const auto page = served.client.Get("/");
  ASSERT_EQ(status(page), 200);
  const std::string nonce = page->body.substr(5);
  EXPECT_EQ(nonce.size(), 32u);
  const std::string policy = page->get_header_value("Content-Security-Policy");
  EXPECT_NE(policy.find("script-src 'nonce-" + nonce + "'"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  const auto elsewhere = served.client.Get("/<script>x");
  EXPECT_EQ(status(elsewhere), 404);
  EXPECT_EQ(elsewhere->body.find("script"), std::string::npos) << "nothing of a request comes back";
}

TEST(LiveServer, IsOnlyRead) {
  Served served;
  for (const auto& answer : {served.client.Post("/", "x", "text/plain"), served.client.Delete("/"),
                             served.client.Put("/events", "x", "text/plain"), served.client.Options("/")})
    EXPECT_EQ(status(answer), 405);
  EXPECT_EQ(status(served.client.Head("/")), 200);
}

TEST(LiveServer, SendsWhatIsPublishedUntilTheEnd) {
  Served served;
  std::string got;
  std::thread reading([&] {
    served.client.Get("/events", [&](const char* bytes, std::size_t size) {
      got.append(bytes, size);
      return true;
    });
  });
  while (!served.feed->needs_whole()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  served.feed->publish(text("data: 1\n\n"), text("data: whole\n\n"));
  served.feed->publish(text("data: 2\n\n"), nullptr);
  served.feed->end(text("event: end\ndata: 0\n\n"));
  reading.join();
  EXPECT_EQ(got, "data: whole\n\ndata: 2\n\nevent: end\ndata: 0\n\n");
}

TEST(LiveServer, AsksForItsToken) {
  Served served("secret");
  for (const char* path : {"/", "/events", "/?token=secre", "/?token=secretx", "/?token=", "/nothing"})
    EXPECT_EQ(status(served.client.Get(path)), 401) << path;
  EXPECT_EQ(status(served.client.Post("/", "x", "text/plain")), 401);
  EXPECT_EQ(status(served.client.Get("/?token=secret")), 200);
  EXPECT_EQ(status(served.client.Get("/", {{"Authorization", "Bearer secret"}})), 200);
  EXPECT_EQ(status(served.client.Get("/", {{"Authorization", "secret"}})), 401);
  EXPECT_EQ(status(served.client.Get("/?token=secret", {{"Host", "elsewhere"}})), 200);
}

TEST(LiveServer, ComparesSecretsAsAWhole) {
  EXPECT_TRUE(is_same_secret("abc", "abc"));
  for (const char* other : {"", "a", "ab", "abd", "abca", "abcabc", "Abc"})
    EXPECT_FALSE(is_same_secret("abc", other)) << other;
}

TEST(LiveServer, AnswersToNamesOfThisMachineAlone) {
  Served served;
  for (const char* name : {"localhost", "localhost:1", "127.0.0.1", "[::1]:8"})
    EXPECT_EQ(status(served.client.Get("/", {{"Host", name}})), 200) << name;
  for (const char* name : {"example.com", "127.0.0.1.example.com", "localhost.example.com:80", ""})
    EXPECT_EQ(status(served.client.Get("/", {{"Host", name}})), 403) << name;
}

TEST(LiveServer, RefusesABusyPort) {
  Served served;
  const int port = served.server.address().port;
  expect_refusal(
      [&] {
        LiveServer({{"127.0.0.1", port}, "", {}}, served.feed);
      },
      0, "127.0.0.1:" + std::to_string(port) + ": another program has that port");
}

TEST(LiveServer, HasFewReadersAtATime) {
  Served served;
  std::vector<std::thread> reading;
  std::atomic<std::size_t> reached = 0;
  for (std::size_t k = 0; k < LiveServer::kMostReaders; ++k)
    reading.emplace_back([&] {
      httplib::Client client("127.0.0.1", served.server.address().port);
      bool is_first = true;
      client.Get("/events", [&](const char*, std::size_t) {
        if (std::exchange(is_first, false)) ++reached;
        return true;
      });
    });
  while (reached < LiveServer::kMostReaders) {
    served.feed->publish(text("c"), text("w"));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const auto refused = served.client.Get("/events");
  EXPECT_EQ(status(refused), 503);
  EXPECT_EQ(status(served.client.Get("/")), 200);
  served.feed->end(text("e"));
  for (std::thread& thread : reading) thread.join();
}

/// Connects, and says these words.
int connection(int port, const std::string& words) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
  EXPECT_EQ(::send(socket, words.data(), words.size(), 0), static_cast<ssize_t>(words.size()));
  return socket;
}

TEST(LiveServer, EndsThoughItIsRead) {
  std::vector<int> sockets;
  {
    Served served;
    for (const char* words : {"", "GET / HTTP/1.1\r\n", "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"})
      sockets.push_back(connection(served.server.address().port, words));
    while (!served.feed->is_read()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (const int socket : sockets) ::close(socket);
}

}  // namespace
}  // namespace radioslam
