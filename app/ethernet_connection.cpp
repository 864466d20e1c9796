#include "app/ethernet_connection.h"

#include <netinet/tcp.h>

#include <string_view>
#include <utility>

namespace brick {

namespace {
// A client whose machine is switched off says nothing: without these its place would be taken for ever.
using KeepAliveIdle = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
using KeepAliveInterval = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
using KeepAliveCount = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;
using UserTimeout = asio::detail::socket_option::integer<IPPROTO_TCP, TCP_USER_TIMEOUT>;  // ms, of what is not taken
}  // namespace

EthernetConnection::EthernetConnection(asio::ip::tcp::socket socket, std::size_t most_requests)
    : socket_(std::move(socket)), most_requests_(most_requests) {
  asio::error_code ignored;
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket_.set_option(asio::socket_base::keep_alive(true), ignored);
  socket_.set_option(KeepAliveIdle(static_cast<int>(kIdle.count())), ignored);
  socket_.set_option(KeepAliveInterval(static_cast<int>(kAskAgain.count())), ignored);
  socket_.set_option(KeepAliveCount(kTimesAsked), ignored);
  // One that is switched off while a reply is on its way to it is not asked, the reply is sent again.
  const std::chrono::milliseconds longest = kIdle + kTimesAsked * kAskAgain;
  socket_.set_option(UserTimeout(static_cast<int>(longest.count())), ignored);
}

// Only where nothing waits to be sent and all that was read is being worked at.
void EthernetConnection::read() {
  if (reading_ || ended_ || closed_ || !replies_.empty() || under_way_ >= most_requests_) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(piece_), [self = shared_from_this()](asio::error_code error, std::size_t count) {
    self->reading_ = false;
    if (self->closed_) return;
    if (error == asio::error::eof) {  // it may still listen
      self->ended_ = true;
      return self->close_when_done();
    }
    if (error) return self->close("");
    self->packets_.take(std::string_view(self->piece_.data(), count));
    self->take_packets();
    self->read();
  });
}

void EthernetConnection::take_packets() {
  while (under_way_ < most_requests_) {
    const auto packet = packets_.next();
    if (!packet) break;
    ++under_way_;
    on_request(*packet);
  }
  close_when_done();
}

void EthernetConnection::close_when_done() {
  if (under_way_ > 0 || !replies_.empty()) return;
  if (!packets_.broken().empty())
    close(packets_.broken());
  else if (ended_)
    close("");
}

void EthernetConnection::reply(std::string bytes) {
  --under_way_;
  replies_.push_back(std::move(bytes));
  if (replies_.size() == 1) write();
}

// A reply is one send: clients judge by what one call gives them.
void EthernetConnection::write() {
  asio::async_write(socket_, asio::buffer(replies_.front()),
                    [self = shared_from_this()](asio::error_code error, std::size_t) {
                      if (error) return self->close("");
                      self->replies_.pop_front();
                      if (!self->replies_.empty()) return self->write();
                      self->take_packets();
                      self->read();
                    });
}

void EthernetConnection::close(const std::string& why) {
  if (std::exchange(closed_, true)) return;
  asio::error_code ignored;
  socket_.shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  socket_.close(ignored);
  on_close(why);
}

}  // namespace brick
