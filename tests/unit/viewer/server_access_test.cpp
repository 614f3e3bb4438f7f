// Who gets the page and the session, and at which address.

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "support/eventually.hpp"
#include "unit/viewer/served_session.hpp"

namespace supple::viewer::server_access_test {

TEST_F(ViewerServer, PageNeedsTheToken) {
  start();
  const Answer answer = get(port(), with_token("/"));
  EXPECT_EQ(answer.status, 200u);
  EXPECT_EQ(answer.body, page);
  for (const std::string target : {"/", "/?token=", "/?token=0123456789abcdef0123456789abcdef"}) {
    const Answer refusal = get(port(), target);
    EXPECT_EQ(refusal.status, 403u) << target;
    EXPECT_NE(refusal.body.find("supple view"), std::string::npos) << "does not help: " << refusal.body;
    EXPECT_EQ(refusal.body.find("The page"), std::string::npos);
  }
}

TEST_F(ViewerServer, UrlIsWhatOneOpens) {
  start();
  const Server other(Session(small_show()), {"127.0.0.1", 0, page});
  EXPECT_EQ(other.url(), "http://127.0.0.1:" + std::to_string(other.port()) + "/?token=" + other.token());
  EXPECT_EQ(get(port(), "/?token=" + other.token()).status, 403u) << "each server has its own token";
}

TEST_F(ViewerServer, PageIsNotKeptNorFramedNorMayItLoadAnything) {
  start();
  for (const char* const target : {"/", "/nothing"}) {
    auto fields = get(port(), with_token(target)).fields;
    EXPECT_EQ(fields["Cache-Control"], "no-store");
    EXPECT_EQ(fields["X-Content-Type-Options"], "nosniff");
    EXPECT_EQ(fields["Referrer-Policy"], "no-referrer");
    const std::string policy = fields["Content-Security-Policy"];
    for (const std::string part :
         {"default-src 'none'", "frame-ancestors 'none'", "connect-src 'self' ws://"})
      EXPECT_NE(policy.find(part), std::string::npos) << policy;
    EXPECT_EQ(policy.find('*'), std::string::npos) << policy;
  }
}

TEST_F(ViewerServer, ThereIsNothingElse) {
  start();
  for (const std::string path : {"/favicon.ico", "/index.html", "/../etc/passwd", "/session", "//"})
    EXPECT_EQ(get(port(), with_token(path)).status, 404u) << path;
}

TEST_F(ViewerServer, OtherMethodsAreRefused) {
  start();
  const std::string rest = " HTTP/1.1\r\nHost: " + own_host() + "\r\n\r\n";
  for (const std::string method : {"PUT ", "DELETE ", "OPTIONS "})
    EXPECT_EQ(ask(port(), method + with_token("/") + rest).status, 405u) << method;
  const Answer head = ask(port(), "HEAD " + with_token("/") + rest, true);
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(head.fields.at("Content-Length"), std::to_string(page.size()));
}

TEST_F(ViewerServer, HostMustBeItself) {
  start();
  const std::string number = ":" + std::to_string(port());
  EXPECT_EQ(get(port(), with_token("/"), "localhost" + number).status, 200u);
  for (const std::string& host : {std::string(), "evil.example" + number, std::string("127.0.0.1"),
                                  std::string("127.0.0.1:1"), "127.0.0.1.evil.example" + number}) {
    const Answer refusal = get(port(), with_token("/"), host);
    EXPECT_EQ(refusal.status, 403u) << host;
    EXPECT_NE(refusal.body.find(own_host()), std::string::npos) << refusal.body;
  }
}

TEST_F(ViewerServer, WhatIsNoRequestIsRefused) {
  start();
  EXPECT_EQ(ask(port(), "\x16\x03\x01 hello\r\n\r\n").status, 400u);
  EXPECT_EQ(ask(port(), "GET / HTTP/1.1\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n").status, 413u);
  EXPECT_EQ(get(port(), with_token("/")).status, 200u) << "the server continues";
}

TEST_F(ViewerServer, SlowConnectionsDoNotKeepNewClientsOut) {
  rlimit files{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, 4096);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &files), 0);
  start();
  const std::size_t count = std::min<std::size_t>(1000, files.rlim_cur - 200);
  boost::asio::io_context context;
  std::vector<boost::asio::ip::tcp::socket> slow;
  const std::string begin = "GET " + with_token("/") + " HTTP/1.1\r\nHost: " + own_host() + "\r\n";
  for (std::size_t i = 0; i < count; ++i) {
    slow.emplace_back(context).connect({boost::asio::ip::make_address("127.0.0.1"), port()});
    boost::system::error_code may_be_dropped;
    boost::asio::write(slow.back(), boost::asio::buffer(begin), may_be_dropped);
  }
  const auto is_closed = [](boost::asio::ip::tcp::socket& socket) {
    pollfd connection{socket.native_handle(), POLLRDHUP, 0};
    return poll(&connection, 1, 0) == 1;
  };
  // The newest one may still end its request.
  boost::asio::write(slow.back(), boost::asio::buffer("\r\n", 2));
  std::string answer;
  boost::system::error_code end_of_answer;
  boost::asio::read(slow.back(), boost::asio::dynamic_buffer(answer), end_of_answer);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;

  EXPECT_EQ(get(port(), with_token("/")).status, 200u);
  EXPECT_EQ(connect().receive().kind, Kind::scene);
  EXPECT_TRUE(eventually([&] { return std::ranges::count_if(slow, is_closed) + 16 >= std::ssize(slow); }));
}

TEST_F(ViewerServer, SessionNeedsTokenHostAndOrigin) {
  start();
  const std::string token = with_token("").substr(7), host = own_host();
  const auto is_let_in = [&](const std::string& given_token, const std::string& given_host,
                             const std::string& origin, const std::string& path = "/session") {
    try {
      PageClient client(port(), given_token, given_host, origin, path);
      return client.receive().kind == Kind::scene;
    } catch (const boost::system::system_error& error) {
      EXPECT_EQ(error.code(), boost::beast::websocket::error::upgrade_declined);
      return false;
    }
  };
  EXPECT_TRUE(is_let_in(token, host, "http://" + host));
  EXPECT_TRUE(is_let_in(token, host, "")) << "no browser";
  const std::string local = "localhost:" + std::to_string(port());
  EXPECT_TRUE(is_let_in(token, local, "http://" + local));

  EXPECT_FALSE(is_let_in("", host, "http://" + host));
  EXPECT_FALSE(is_let_in(std::string(32, '0'), host, "http://" + host));
  for (const std::string origin : {"null", "http://evil.example", "http://127.0.0.1:1", "file://"})
    EXPECT_FALSE(is_let_in(token, host, origin)) << origin;
  EXPECT_FALSE(is_let_in(token, host, "https://" + host));
  EXPECT_FALSE(is_let_in(token, host, "http://" + local));
  EXPECT_FALSE(is_let_in(token, "evil.example", "http://evil.example"));
  EXPECT_FALSE(is_let_in(token, host, "http://" + host, "/"));
  EXPECT_FALSE(is_let_in(token, host, "http://" + host, "/other"));
}

TEST(ViewerServerOptions, SaysWhatIsWrongWithAnAddress) {
  const auto error_of = [](const std::string& address, std::uint16_t port) -> std::string {
    try {
      const Server server(Session(small_show()), {address, port, page});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Server first(Session(small_show()), {"127.0.0.1", 0, page});
  EXPECT_NE(error_of("127.0.0.1", first.port()).find("Address already in use"), std::string::npos);
  EXPECT_NE(error_of("somewhere", 0).find("somewhere: it is not an IP address"), std::string::npos);
  EXPECT_NE(error_of("203.0.113.1", 0).find("203.0.113.1, port 0: cannot listen"), std::string::npos);
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_THROW(is_loopback("localhost:80"), Error);
}

}  // namespace supple::viewer::server_access_test
