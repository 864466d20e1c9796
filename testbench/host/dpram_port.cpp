#include "testbench/host/dpram_port.h"

#include <utility>

#include "rtl/regs/dpram_map.h"

namespace brick {
namespace {

constexpr std::uint16_t kCommandWaits = 1;
constexpr std::size_t kPiece = DPRAM_COMMAND_BYTES - 1;
constexpr char kMoreFollows = ' ';  // in the last place of a piece that is not the last: anything but NUL

}  // namespace

bool DpramPort::wait_free(std::uint32_t offset, std::uint16_t bits, Tick timeout) {
  const Tick begin = ram_.now(), limit = begin + timeout;
  while ((ram_.read(offset) & bits) != 0) {
    if (ram_.now() >= limit) return false;
    ram_.pause(begin, limit);
  }
  return true;
}

void DpramPort::write_piece(const std::string& text, bool last) {
  std::string bytes = text + (last ? '\0' : kMoreFollows);
  if (bytes.size() % 2 != 0) bytes += '\0';
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const unsigned low = static_cast<unsigned char>(bytes[i]), high = static_cast<unsigned char>(bytes[i + 1]);
    ram_.write(static_cast<std::uint32_t>(DPRAM_COMMAND_TEXT + i), static_cast<std::uint16_t>(low | high << 8));
  }
  ram_.write(DPRAM_COMMAND_CONTROL, kCommandWaits);
}

bool DpramPort::send(const std::string& line, Tick timeout) {
  for (std::size_t from = 0;; from += kPiece) {
    if (!wait_free(DPRAM_COMMAND_CONTROL, kCommandWaits, timeout)) return false;
    const bool last = line.size() - from <= kPiece;
    write_piece(line.substr(from, kPiece), last);
    if (last) return true;
  }
}

bool DpramPort::control(std::uint8_t c, Tick timeout) {
  if (!wait_free(DPRAM_CONTROL_CHARACTER, 0xFF, timeout)) return false;
  ram_.write(DPRAM_CONTROL_CHARACTER, c);
  return wait_free(DPRAM_CONTROL_CHARACTER, 0xFF, timeout);
}

std::optional<DpramPort::Response> DpramPort::look() const {
  Response response{ram_.read(DPRAM_RESPONSE_CONTROL), 0, ""};
  if (response.code == 0) return std::nullopt;
  response.count = ram_.read(DPRAM_RESPONSE_COUNT);
  for (std::uint32_t i = 0; i < DPRAM_RESPONSE_BYTES; ++i) {
    const std::uint16_t word = ram_.read(DPRAM_RESPONSE_TEXT + (i & ~1U));
    const char c = static_cast<char>(i % 2 == 0 ? word : word >> 8);
    if (c == '\0') break;
    response.text += c;
  }
  return response;
}

std::optional<DpramPort::Response> DpramPort::take(Tick timeout) {
  const Tick begin = ram_.now(), limit = begin + timeout;
  std::optional<Response> response = look();
  while (!response && ram_.now() < limit) {
    ram_.pause(begin, limit);
    response = look();
  }
  if (response) ram_.write(DPRAM_RESPONSE_CONTROL, 0);
  return response;
}

Reply DpramPort::finish(Tick timeout) {
  Reply reply;
  while (std::optional<Response> response = take(timeout)) {
    reply.error = (response->code & DPRAM_RESPONSE_ERROR) != 0;
    reply.complete = reply.error || response->code == DPRAM_RESPONSE_ACKNOWLEDGE;
    if (reply.error) {
      std::string number = "000";
      for (unsigned i = 0; i < 3; ++i) number[i] = static_cast<char>('0' + (response->code >> (8 - 4 * i) & 0xF));
      reply.lines.push_back("ERR" + number);
    }
    if (reply.complete) return reply;
    (response->code == DPRAM_RESPONSE_LINE ? reply.lines : unsolicited_).push_back(std::move(response->text));
  }
  return reply;
}

Reply DpramPort::command(const std::string& line, Tick timeout) {
  return send(line, timeout) ? finish(timeout) : Reply{};
}

std::vector<std::string> DpramPort::take_unsolicited() { return std::exchange(unsolicited_, {}); }

}  // namespace brick
