// The ASCII port in the dual-ported RAM as host software uses it (host-bus:6.6): lines of up to 255 characters in
// pieces, control characters, answers line by line. What programs send in between is kept apart. How words are reached
// and how time passes is the business of DpramAccess, so that the same driver works on a bus and without one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"
#include "testbench/host/reply_parser.h"

namespace brick {

class HostBus;

// 16-bit words of the RAM by their byte offset (rtl/regs/dpram_map.h).
class DpramAccess {
 public:
  virtual ~DpramAccess() = default;
  virtual std::uint16_t read(std::uint32_t offset) = 0;
  virtual void write(std::uint32_t offset, std::uint16_t word) = 0;
  virtual Tick now() = 0;
  virtual void pause(Tick since, Tick limit) = 0;  // after a look that found nothing, of a wait so long
};

class BusDpram : public DpramAccess {
 public:
  explicit BusDpram(HostBus& bus) : bus_(bus) {}
  std::uint16_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint16_t word) override;
  Tick now() override;
  void pause(Tick since, Tick limit) override;

 private:
  HostBus& bus_;
};

class DpramPort {
 public:
  static constexpr Tick kReplyTime = ns_to_ticks(1'000'000'000);

  // A line as it stands in the buffer.
  struct Response {
    std::uint16_t code;   // DPRAM_RESPONSE_...
    std::uint16_t count;  // the word of length
    std::string text;     // up to its NUL
  };

  explicit DpramPort(DpramAccess& ram) : ram_(ram) {}

  // Each is false, or nothing, when the controller does not take or answer for `timeout`.
  bool send(const std::string& line, Tick timeout = kReplyTime);
  bool control(std::uint8_t c, Tick timeout = kReplyTime);  // returns when it has acted
  std::optional<Response> look() const;                     // what stands in the buffer, which stays
  std::optional<Response> take(Tick timeout = kReplyTime);  // and is released
  Reply finish(Tick timeout = kReplyTime);  // the answer to a line; an error is the last line, "ERRnnn", as of HostLink
  Reply command(const std::string& line, Tick timeout = kReplyTime);

  // What programs have sent, and what their commands have answered, since the last call.
  std::vector<std::string> take_unsolicited();

 private:
  bool wait_free(std::uint32_t offset, std::uint16_t bits, Tick timeout);
  void write_piece(const std::string& text, bool last);

  DpramAccess& ram_;
  std::vector<std::string> unsolicited_;
};

}  // namespace brick
