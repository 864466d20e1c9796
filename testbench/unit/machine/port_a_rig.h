// The bus master alone, with a board made of one function of time.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "systemc/cpu/port_a.h"

namespace brick {

// Presents accesses to the bus master and moves the pins along, with a board that shows `board(tick)`.
class PortARig {
 public:
  explicit PortARig(std::function<BoardOutputs(Tick)> board = [](Tick) { return BoardOutputs{}; })
      : board_(std::move(board)) {
    port_a.on_cycle = [this](const PortACycle& c) { last = c; };
    port_a.reset(0, 0, pins);
    payload_.set_extension(&request_);
    payload_.set_data_ptr(reinterpret_cast<unsigned char*>(&data_));
  }
  ~PortARig() { payload_.clear_extension(&request_); }

  tlm::tlm_response_status access(char space, std::uint32_t address, bool write, std::uint32_t data = 0,
                                  unsigned bytes = 4) {
    payload_.set_address(kPmacBase + 8ull * address + (space == 'X' ? 4 : 0));
    payload_.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
    payload_.set_data_length(bytes);
    payload_.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    data_ = data;
    request_.start = cycle;
    auto& bus = static_cast<sc_core::sc_export<tlm::tlm_fw_transport_if<>>&>(port_a.socket);
    for (;;) {
      sc_core::sc_time delay;
      bus->b_transport(payload_, delay);
      if (payload_.get_response_status() != tlm::TLM_INCOMPLETE_RESPONSE) break;
      while (port_a.running()) {
        EXPECT_GE(port_a.stands_at(), now) << "the board would have to go back";
        for (; now < port_a.stands_at(); ++now)
          if (board_(now + 1) != board_(now)) port_a.board_changed(now + 1, board_(now + 1));
        const BoardInputs before = pins;
        port_a.step(pins, board_(now));
        if (port_a.strobe_moved()) port_a.board_follows(board_(now));
        if (on_pins) on_pins(now, before, pins);
      }
    }
    cycle = request_.done;
    return payload_.get_response_status();
  }
  std::uint32_t read(char space, std::uint32_t address) {
    EXPECT_EQ(access(space, address, false), tlm::TLM_OK_RESPONSE);
    return data_;
  }
  void write(char space, std::uint32_t address, std::uint32_t data) {
    EXPECT_EQ(access(space, address, true, data), tlm::TLM_OK_RESPONSE);
  }
  void set_clock(unsigned multiplier) { write('X', 0xFFFFFD, multiplier - 1); }
  void set_wait_states(unsigned ws) {  // all areas
    const unsigned three_bits = std::min(ws, 7u);
    write('X', 0xFFFFFB, ws | ws << 5 | three_bits << 10 | three_bits << 13 | ws << 16);
  }

  Signals signals;
  PortA port_a{sc_core::sc_gen_unique_name("port_a"), signals};
  BoardInputs pins;
  std::optional<PortACycle> last;
  Tick now = 0;
  std::function<void(Tick, const BoardInputs& before, const BoardInputs& after)> on_pins;
  std::int64_t cycle = 12;

 private:
  std::function<BoardOutputs(Tick)> board_;
  PortARequest request_;
  tlm::tlm_generic_payload payload_;
  std::uint32_t data_ = 0;
};

}  // namespace brick
