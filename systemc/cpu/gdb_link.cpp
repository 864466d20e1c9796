// The sockets are Asio's. They block, except where this file looks without waiting.
#include "systemc/cpu/gdb_link.h"

#include <array>
#include <stdexcept>

#include <asio.hpp>

#include "systemc/cpu/gdb_hex.h"

namespace brick {

using asio::ip::tcp;

struct GdbLink::Impl {
  static constexpr char kBreak = 0x03;

  asio::io_context io;
  tcp::acceptor acceptor{io};
  tcp::socket socket{io};
  std::string input;  // received and not yet looked at
  std::string sent;   // the last packet, for a debugger that asks for it again
  bool acks = true;

  // Takes what has come, after waiting for it if asked; false when the connection has gone.
  bool fill(bool wait) {
    std::array<char, 4096> piece;
    asio::error_code error, ignored;
    if (!wait) socket.non_blocking(true, ignored);
    const std::size_t n = socket.read_some(asio::buffer(piece), error);
    if (!wait) socket.non_blocking(false, ignored);
    if (error) return error == asio::error::would_block || error == asio::error::interrupted;
    input.append(piece.data(), n);
    return true;
  }

  // Waits for one byte; -1 when the connection has gone.
  int next() {
    while (input.empty()) {
      if (!fill(true)) return -1;
    }
    const char c = input.front();
    input.erase(0, 1);
    return static_cast<unsigned char>(c);
  }

  // An error shows at the next read.
  void write(const std::string& bytes) {
    asio::error_code ignored;
    asio::write(socket, asio::buffer(bytes), ignored);
  }

  bool take_connection() {
    tcp::socket fresh(io);
    asio::error_code error;
    acceptor.accept(fresh, error);
    if (error) return false;
    socket = std::move(fresh);
    socket.set_option(tcp::no_delay(true), error);
    input.clear();
    sent.clear();
    acks = true;
    return true;
  }
};

GdbLink::GdbLink(std::uint16_t port) : impl_(std::make_unique<Impl>()) {
  try {
    const tcp::endpoint place(asio::ip::address_v4::loopback(), port);
    impl_->acceptor.open(place.protocol());
    impl_->acceptor.set_option(tcp::acceptor::reuse_address(true));
    impl_->acceptor.bind(place);
    impl_->acceptor.listen();
  } catch (const asio::system_error& e) {
    throw std::runtime_error("cannot listen on 127.0.0.1:" + std::to_string(port) + ": " + e.code().message());
  }
}

GdbLink::~GdbLink() = default;

std::uint16_t GdbLink::port() const { return impl_->acceptor.local_endpoint().port(); }
bool GdbLink::connected() const { return impl_->socket.is_open(); }

void GdbLink::accept() {
  while (!impl_->take_connection()) {}
}

bool GdbLink::try_accept() {
  asio::error_code ignored;
  impl_->acceptor.non_blocking(true, ignored);
  const bool taken = impl_->take_connection();
  impl_->acceptor.non_blocking(false, ignored);
  return taken;
}

void GdbLink::close() {
  asio::error_code ignored;
  impl_->socket.close(ignored);
  impl_->input.clear();
}

std::optional<GdbLink::Packet> GdbLink::receive() {
  Packet packet{};
  enum { kOutside, kBody, kEscaped } place = kOutside;
  unsigned sum = 0;
  std::size_t length = 0;
  while (true) {
    const int c = impl_->next();
    if (c < 0) {
      close();
      return {};
    }
    if (place == kOutside || c == '$') {
      if (c == '-' && place == kOutside && impl_->acks) impl_->write(impl_->sent);
      if (c != '$') continue;
      packet = {};
      place = kBody;
      sum = 0;
      length = 0;
      continue;
    }
    if (c != '#') {
      sum += static_cast<unsigned>(c);
      packet.too_long = ++length > kMaxPacket;
      if (packet.too_long) continue;
      if (place == kBody && c == '}') {
        place = kEscaped;
      } else {
        packet.data += static_cast<char>(place == kEscaped ? c ^ 0x20 : c);
        place = kBody;
      }
      continue;
    }
    place = kOutside;
    const int high = impl_->next(), low = high < 0 ? -1 : impl_->next();
    if (low < 0) {
      close();
      return {};
    }
    if (!impl_->acks) return packet;
    const int h = gdb::digit(static_cast<char>(high)), l = gdb::digit(static_cast<char>(low));
    const bool sound = h >= 0 && l >= 0 && (sum & 0xFF) == static_cast<unsigned>(16 * h + l);
    impl_->write(sound ? "+" : "-");
    if (sound) return packet;
  }
}

void GdbLink::send(const std::string& data) {
  std::string packet = "$";
  unsigned sum = 0;
  const auto put = [&](char c) {
    packet += c;
    sum += static_cast<unsigned char>(c);
  };
  for (const char c : data) {
    const bool escape = c == '$' || c == '#' || c == '}' || c == '*';
    if (escape) put('}');
    put(escape ? static_cast<char>(c ^ 0x20) : c);
  }
  packet += '#';
  gdb::put_byte(packet, static_cast<std::uint8_t>(sum));
  impl_->sent = packet;
  impl_->write(packet);
}

bool GdbLink::interrupted() {
  if (!connected()) return false;
  if (impl_->input.size() < kMaxPacket && !impl_->fill(false)) {
    close();
    return false;
  }
  const std::size_t begin = impl_->input.find_first_not_of("+-");
  impl_->input.erase(0, begin);
  if (impl_->input.empty() || impl_->input.front() != Impl::kBreak) return false;
  impl_->input.erase(0, 1);
  return true;
}

void GdbLink::stop_acks() { impl_->acks = false; }

}  // namespace brick
