#include "app/page/page_session.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace brick {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

namespace {

constexpr std::uint32_t kMostHeader = 8192;           // bytes of a request
constexpr std::chrono::seconds kRequestPatience{10};  // for all of it
constexpr std::chrono::seconds kSilence{30};          // of a websocket, which is asked after half of it
constexpr int kSendBuffer = 64 << 10;                 // what lies there is old when it is read
constexpr std::size_t kMostTexts = 64;                // told to somebody who does not read

std::vector<std::string> fields(const http::request<http::empty_body>& request, http::field name) {
  std::vector<std::string> list;
  const auto range = request.equal_range(name);
  for (auto at = range.first; at != range.second; ++at) list.emplace_back(at->value());
  return list;
}

std::string text_of(nlohmann::json message) {
  return message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

PageSession::PageSession(boost::asio::ip::tcp::socket socket, const PageSite& site)
    : site_(site), stream_(std::move(socket)), buffer_(kMostHeader + kMostPageMessage) {
  Error ignored;
  auto& plain = stream_.next_layer().socket();
  plain.set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  plain.set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
}

// ---------------------------------------------------------------------------------------------------------------- HTTP

void PageSession::start() {
  parser_.emplace();
  parser_->header_limit(kMostHeader);
  stream_.next_layer().expires_after(kRequestPatience);
  http::async_read(stream_.next_layer(), buffer_, *parser_,
                   [self = shared_from_this()](Error error, std::size_t) { self->requested(error); });
}

void PageSession::requested(Error error) {
  if (closed_) return;  // to make room, while this was on its way here
  if (error == http::error::header_limit) return refuse(431, "the header is too long; expected 8192 bytes at most");
  if (error == http::error::end_of_stream || error == http::error::partial_message || error == beast::error::timeout)
    return close();
  if (error.category() == http::make_error_code(http::error::bad_method).category())
    return refuse(400, "this is no request; expected HTTP/1.1");
  if (error) return close();
  const auto& request = parser_->get();
  const PageVerdict verdict = site_.rules.judge({std::string(request.method_string()), std::string(request.target()),
                                                 fields(request, http::field::host),
                                                 fields(request, http::field::origin), websocket::is_upgrade(request)});
  if (!verdict.why.empty()) return refuse(verdict.status, verdict.why);
  if (websocket::is_upgrade(request)) return upgrade();
  respond(verdict.status, "text/html; charset=utf-8", site_.html);
}

void PageSession::refuse(unsigned status, const std::string& why) {
  respond(status, "text/plain; charset=utf-8", why + "\n");
}

void PageSession::respond(unsigned status, const std::string& type, std::string body) {
  response_.version(11);
  response_.result(status);
  response_.keep_alive(false);
  response_.set(http::field::content_type, type);
  response_.set(http::field::cache_control, "no-store");
  response_.set("Content-Security-Policy", site_.policy);
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.body() = std::move(body);
  response_.prepare_payload();
  http::async_write(stream_.next_layer(), response_, [self = shared_from_this()](Error, std::size_t) {
    Error ignored;
    self->stream_.next_layer().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    self->close();
  });
}

void PageSession::close() {
  if (std::exchange(closed_, true)) return;
  open_ = false;
  stream_.next_layer().close();
  if (on_close) on_close();
}

// ----------------------------------------------------------------------------------------------------------- websocket

void PageSession::upgrade() {
  if (!on_open()) return refuse(503, "there are too many pages open; expected 16 at most");
  stream_.next_layer().expires_never();  // the websocket has time limits of its own
  websocket::stream_base::timeout limits{kRequestPatience, kSilence, true};
  stream_.set_option(limits);
  stream_.read_message_max(kMostPageMessage);
  stream_.async_accept(parser_->get(), [self = shared_from_this()](Error error) {
    if (error || self->closed_) return self->close();
    self->open_ = true;
    self->buffer_.clear();
    self->say(self->site_.about);
    self->read();
    self->write();  // a state that came meanwhile
  });
}

// Goes on while answers are out, so that pongs are seen; not from one that does not read what it is told.
void PageSession::read() {
  if (closed_ || reading_ || texts_.size() >= kMostTexts) return;
  reading_ = true;
  stream_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
    self->reading_ = false;
    if (error || self->closed_) return self->close();
    self->take_message();
    self->read();
  });
}

void PageSession::take_message() {
  const std::string text = beast::buffers_to_string(buffer_.data());
  buffer_.clear();
  try {
    const PageMessage message = parse_page_message(text);
    if (const auto* watch = std::get_if<PageWatch>(&message)) return on_watch(*watch);
    const auto& command = std::get<PageCommand>(message);
    if (site_.read_only) throw PageMistake("the page is read only (--page-read-only)", command.id);
    if (commands_ >= site_.most_commands)
      throw PageMistake(std::to_string(site_.most_commands) + " commands wait; expected answers first", command.id);
    ++commands_;
    on_command(command);
  } catch (const PageMistake& e) {
    nlohmann::json mistake{{"kind", "mistake"}, {"text", e.what()}};
    if (e.id) mistake["id"] = *e.id;
    say(text_of(std::move(mistake)));
  }
}

void PageSession::answer(std::string text) {
  --commands_;
  say(std::move(text));
  read();
}

void PageSession::say(std::string text) {
  texts_.push_back(std::move(text));
  write();
}

void PageSession::state(std::shared_ptr<const std::string> newest) {
  state_ = std::move(newest);
  write();
}

void PageSession::write() {
  if (closed_ || !open_ || writing_ || (texts_.empty() && !state_)) return;
  boost::asio::const_buffer what;
  if (!texts_.empty()) {
    sending_ = std::move(texts_.front());
    texts_.pop_front();
    what = boost::asio::buffer(sending_);
  } else {
    sent_ = std::exchange(state_, nullptr);
    what = boost::asio::buffer(*sent_);
  }
  writing_ = true;
  stream_.text(true);
  stream_.async_write(what, [self = shared_from_this()](Error error, std::size_t) {
    self->writing_ = false;
    if (error) return self->close();
    self->write();
    self->read();
  });
}

}  // namespace brick
