#include <brick/board.h>

#include <map>

#include "systemc/component/board/board_buses.h"
#include "systemc/component/board/board_pins.h"
#include "systemc/component/board/board_words.h"
#include "systemc/component/chip.h"
#include "systemc/component/error.h"
#include "systemc/component/servo_ic/servo_ic_pins.h"

namespace brick::component {
namespace {

std::vector<PinInfo> make_table(std::uint32_t fitted) {
  using namespace board_words;
  std::vector<PinInfo> table = board_rows();
  for (PinInfo& info : table)
    if (info.name == "fitted") info.idle = fitted;
  for (unsigned ic = 0, k = 0; ic < kMaxServoIcs; ++ic)
    if ((fitted >> ic & 1) != 0) {
      add_motor_pins(table, servo_ic_scope(ic) + "_", motor_input(k), motor_output(k));
      ++k;
    }
  return table;
}

}  // namespace

const std::vector<PinInfo>& Board::pin_table(std::uint32_t fitted) {
  static std::map<std::uint32_t, std::vector<PinInfo>> tables;
  const auto [place, fresh] = tables.try_emplace(fitted);
  if (fresh) place->second = make_table(fitted);
  return place->second;
}

BoardServoIc::BoardServoIc(Component& board, const std::string& ic)
    : ServoIcSerialPins(board, ic),
      ch{ServoIcChannel{board, 1, ic}, ServoIcChannel{board, 2, ic}, ServoIcChannel{board, 3, ic},
         ServoIcChannel{board, 4, ic}} {}

namespace {
std::uint32_t checked(std::uint32_t fitted) {
  constexpr unsigned kIcs = 22;  // as many as BoardInputs::fitted has bits
  if (fitted >> kIcs != 0) raise_error("/brick/fitted", "BoardOptions::fitted has bits beyond 21, the last MACRO IC");
  return fitted;
}
}  // namespace

constexpr std::uint64_t kPortABytes = std::uint64_t{8} << 24;  // X and Y of 2^24 words

Board::Board(const sc_core::sc_module_name& name, TimeBase& time, const BoardOptions& options, const Engine& engine)
    : Component(name, time, pin_table(checked(options.fitted)), {{4, kPortABytes}, {1, 0}}), BoardPins(*this, "") {
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if ((options.fitted >> ic & 1) != 0)
      servo_ic.push_back(std::make_unique<BoardServoIc>(*this, servo_ic_scope(ic) + "_"));
  set_chip(engine.factory().board(options.fitted, options.seed));
  port_a.register_b_transport(this, &Board::transport_port_a);
  port_a.register_transport_dbg(this, &Board::debug_port_a);
  isa_io.register_b_transport(this, &Board::transport_io);
  isa_memory.register_b_transport(this, &Board::transport_memory);
  isa_memory.register_transport_dbg(this, &Board::debug_memory);
}

}  // namespace brick::component
