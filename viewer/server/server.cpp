#include "server.hpp"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cstddef>
#include <exception>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "access.hpp"
#include "page.hpp"
#include "session_thread.hpp"
#include "spectators.hpp"
#include "supple/error.hpp"
#include "supple/version.hpp"

namespace supple::viewer {
namespace {

/// Stop reading when this many bytes of commands wait for the current step to end.
constexpr std::size_t most_waiting = std::size_t{4} << 20;
/// Most connections that have not shown the token, from one address and in all. A new one replaces the
/// oldest.
constexpr std::ptrdiff_t most_strangers_of_address = 16;
constexpr std::size_t most_strangers = 64;

asio::ip::address parse_address(const std::string& text) {
  error_code error;
  const auto address = asio::ip::make_address(text, error);
  if (!error) return address;
  throw Error(text +
              ": it is not an IP address; give one of this machine, such as 127.0.0.1, or 0.0.0.0 for all");
}

constexpr std::string_view no_token_page = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Supple</title>
<style>body { font: 16px/1.5 system-ui, sans-serif; max-width: 40em; margin: 20vh auto; padding: 0 1em; color-scheme: light dark }</style>
<h1>This address is not complete</h1>
<p><code>supple view</code> prints an address with a token in it, which keeps others out. Open the page by that address; it is
another one each time the program starts.</p>
</html>
)";

/// A connection until it is answered or becomes a `Page`.
class Request : public std::enable_shared_from_this<Request> {
 public:
  struct Context {
    const Access& access;
    std::string_view page, watching_page;
    std::function<void(beast::tcp_stream, const http::request<http::empty_body>&)> connect, watch;
    std::list<Request*>& strangers;  ///< that have not shown the token, oldest first
  };

  Request(tcp::socket socket, const asio::ip::address& peer, const Context& context)
      : stream_(std::move(socket)), peer_(peer), context_(context) {
    context_.strangers.push_back(this);
  }
  ~Request() { context_.strangers.remove(this); }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;

  const asio::ip::address& peer() const { return peer_; }

  void read() {
    stream_.expires_after(5s);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) return self->answer();
      if (error == http::error::body_limit || error == http::error::header_limit)
        return self->refuse(http::status::payload_too_large, "The request is too large.\n");
      if (error.category() == make_error_code(http::error::end_of_stream).category() &&
          error != http::error::end_of_stream && error != http::error::partial_message)
        self->refuse(http::status::bad_request, "This is not an HTTP request.\n");
    });
  }

  /// Ends the connection.
  void drop() {
    context_.strangers.remove(this);
    stream_.close();
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const std::string_view host = text(request[http::field::host]);
    if (!context_.access.knows_host(host)) {
      const std::string wrong = "This server does not have that name or port; use http://";
      return refuse(http::status::forbidden, wrong + context_.access.host() + '\n');
    }
    const Target target = parse_target(text(request.target()));
    if (target.path == "/session" && websocket::is_upgrade(request)) return connect(host, target.token);
    if (target.path != "/") return refuse(http::status::not_found, "There is nothing here.\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return refuse(http::status::method_not_allowed, "Only GET and HEAD are supported.\n");
    if (context_.access.may_watch(target.token)) {
      context_.strangers.remove(this);
      respond(http::status::ok, "text/html; charset=utf-8", context_.watching_page);
    } else if (!context_.access.knows_token(target.token)) {
      respond(http::status::forbidden, "text/html; charset=utf-8", no_token_page);
    } else {
      context_.strangers.remove(this);
      respond(http::status::ok, "text/html; charset=utf-8", context_.page);
    }
  }

  void connect(std::string_view host, std::string_view token) {
    const auto& request = parser_.get();
    if (!Access::is_own_origin(text(request[http::field::origin]), host))
      return refuse(http::status::forbidden, "Pages of other sites have no access.\n");
    if (context_.access.may_watch(token)) return context_.watch(std::move(stream_), request);
    if (!context_.access.knows_token(token)) return refuse(http::status::forbidden, "The token is wrong.\n");
    context_.connect(std::move(stream_), request);
  }

  void refuse(http::status status, std::string_view message) {
    body_ = message;
    respond(status, "text/plain; charset=utf-8", body_);
  }

  void respond(http::status status, const char* type, std::string_view body) {
    response_.emplace(status, 11);
    http::response<http::span_body<const char>>& response = *response_;
    response.set(http::field::server, "supple " SUPPLE_VERSION);
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("Referrer-Policy", "no-referrer");  // the address contains the token
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    const std::string_view host = text(parser_.get()[http::field::host]);
    response.set("Content-Security-Policy",
                 content_policy(context_.access.knows_host(host) ? host : context_.access.host()));
    response.keep_alive(false);
    response.body() = {body.data(), body.size()};
    response.prepare_payload();
    if (parser_.get().method() == http::verb::head) response.body() = {};
    stream_.expires_after(30s);
    http::async_write(stream_, response, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      self->stream_.expires_after(2s);
      self->drain();
    });
  }

  /// Closing a socket with unread data resets it, and the peer may lose the answer.
  void drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(buffer_.max_size()),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (!error) self->drain();
                            });
  }

  static std::string_view text(beast::string_view view) { return {view.data(), view.size()}; }

  beast::tcp_stream stream_;
  asio::ip::address peer_;
  Context context_;
  beast::flat_buffer buffer_{16 * 1024};
  http::request_parser<http::empty_body> parser_;
  std::string body_;
  std::optional<http::response<http::span_body<const char>>> response_;
};

}  // namespace

bool is_loopback(const std::string& address) {
  return parse_address(address).is_loopback();
}

class Server::Implementation {
 public:
  Implementation(Session session, const ServerOptions& options)
      : options_(options),
        acceptor_(listen(sockets_, options)),
        access_(options.address, acceptor_.local_endpoint().port(),
                options.token.empty() ? make_token() : options.token,
                options.watching_page.empty() ? "" : make_token()),
        requests_{
            access_,
            options.page,
            options.watching_page,
            [this](beast::tcp_stream stream, const auto& request) { connect(std::move(stream), request); },
            [this](beast::tcp_stream stream, const auto& request) {
              spectators_.accept(std::move(stream), request);
            },
            strangers_},
        clock_(sockets_),
        session_(std::move(session), listener()) {}

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  const Access& access() const { return access_; }

  void wake() { session_.wake(); }

  void run(const std::function<bool()>& should_end) {
    accept();
    watch(should_end);
    sockets_.run();
    if (failure_) std::rethrow_exception(failure_);
    if (has_failed_) throw Error("the session has failed; the page shows the reason");
  }

 private:
  static tcp::acceptor listen(asio::io_context& sockets, const ServerOptions& options) {
    const tcp::endpoint endpoint(parse_address(options.address), options.port);
    try {
      tcp::acceptor acceptor(sockets);
      acceptor.open(endpoint.protocol());
      acceptor.set_option(asio::socket_base::reuse_address(true));
      acceptor.bind(endpoint);
      acceptor.listen();
      return acceptor;
    } catch (const boost::system::system_error& error) {
      throw Error(options.address + ", port " + std::to_string(options.port) +
                  ": cannot listen: " + error.code().message() +
                  "; choose another port, or 0 for any free port, and an address of this machine");
    }
  }

  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (!error) {
        socket.set_option(tcp::no_delay(true), error);
        const asio::ip::address peer = socket.remote_endpoint(error).address();
        make_room_for(peer);
        std::make_shared<Request>(std::move(socket), peer, requests_)->read();
        return accept();
      }
      clock_of_retry_.expires_after(100ms);
      clock_of_retry_.async_wait([this](error_code) {
        if (acceptor_.is_open()) accept();
      });
    });
  }

  /// Drops the oldest stranger when there are too many, so that slow connections do not keep new ones out.
  void make_room_for(const asio::ip::address& peer) {
    const auto is_of_peer = [&](const Request* request) { return request->peer() == peer; };
    if (std::ranges::count_if(strangers_, is_of_peer) >= most_strangers_of_address)
      (*std::ranges::find_if(strangers_, is_of_peer))->drop();
    else if (strangers_.size() >= most_strangers)
      strangers_.front()->drop();
  }

  void watch(const std::function<bool()>& should_end) {
    if (should_end()) return end(program_ends, "the program has ended");
    clock_.expires_after(100ms);
    clock_.async_wait([this, &should_end](error_code) {
      if (!is_ending_) watch(should_end);
    });
  }

  /// Stops accepting, notifies the connected page, and waits for it at most one second.
  void end(CloseCode code, const char* reason) {
    if (std::exchange(is_ending_, true)) return;
    error_code ignored;
    acceptor_.close(ignored);
    clock_.expires_after(1s);
    clock_.async_wait([this](error_code error) {
      if (!error) sockets_.stop();
    });
    spectators_.close(code, reason);
    if (!page_) return sockets_.stop();
    page_->close(code, reason, [this] { sockets_.stop(); });
  }

  void connect(beast::tcp_stream stream, const http::request<http::empty_body>& request) {
    const PageNumber number = ++page_count_;
    const auto page = std::make_shared<Page>(std::move(stream), options_.patience);
    Page::Listener listener;
    listener.came = [this, number, weak = std::weak_ptr(page)] {
      if (page_) page_->close(taken_over, "taken over by another page");
      page_ = weak.lock();
      page_number_ = number;
      if (is_ending_) return page_->close(program_ends, "the program has ended");
      session_.page_came(number);
    };
    listener.left = [this, number] {
      session_.page_left(number);
      if (page_number_ == number) page_.reset();
      if (options_.drawing.left) options_.drawing.left();
    };
    listener.result = options_.drawing.result;
    listener.sent = [this, number] { session_.message_sent(number); };
    listener.command = [this, number](std::string text) {
      return session_.command(number, std::move(text)) < most_waiting;
    };
    page->accept(request, std::move(listener));
  }

  /// Called on the session thread; continues on the network thread.
  SessionThread::Listener listener() {
    return {[this](PageNumber number, Message message) {
              asio::post(sockets_, [this, number, message] {
                if (!page_ || page_number_ != number) return;
                if (!options_.watching_page.empty()) spectators_.relay(message);
                page_->send(message);
              });
            },
            [this] {
              asio::post(sockets_, [this] {
                if (page_) page_->read_on();
              });
            },
            [this](std::exception_ptr failure) {
              asio::post(sockets_, [this, failure] {
                has_failed_ = true;
                failure_ = failure;
                end(session_failed, "the session has failed");
              });
            }};
  }

  ServerOptions options_;
  std::list<Request*> strangers_;  ///< outlives the requests, which the next member holds
  asio::io_context sockets_{1};
  tcp::acceptor acceptor_;
  Access access_;
  Request::Context requests_;
  asio::steady_timer clock_;
  asio::steady_timer clock_of_retry_{sockets_};
  std::shared_ptr<Page> page_;
  Spectators spectators_{options_.patience};
  PageNumber page_count_ = 0, page_number_ = 0;
  bool is_ending_ = false, has_failed_ = false;
  std::exception_ptr failure_;
  SessionThread session_;  ///< last member: its thread posts to the others
};

Server::Server(Session session, const ServerOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(session), options)) {}

Server::~Server() = default;

std::uint16_t Server::port() const {
  return implementation_->port();
}

const std::string& Server::token() const {
  return implementation_->access().token();
}

std::string Server::url() const {
  const std::string scheme = "http://";
  return scheme + implementation_->access().host() + "/?token=" + token();
}

std::string Server::watching_url() const {
  const Access& access = implementation_->access();
  if (access.watching_token().empty()) return "";
  const std::string scheme = "http://";
  return scheme + access.host() + "/?token=" + access.watching_token();
}

void Server::wake() {
  implementation_->wake();
}

void Server::run(const std::function<bool()>& should_end) {
  implementation_->run(should_end);
}

}  // namespace supple::viewer
