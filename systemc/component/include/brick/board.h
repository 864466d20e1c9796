// The controller board: clock selection, servo and MACRO ICs, watchdog, host port, interrupt controller, host signals,
// dual-ported RAM behind the pins of Port A (the CPU's bus), of ISA and of the connectors. The CPU is the user's: he
// drives Port A. docs/architecture.md, data sheets host-bus and servo-ic.
//
// Each of the two buses is driven by the pins or by its sockets, whose accesses are cycles with real edges on those
// pins inside: docs/port_a.md, host-bus:3.4. A bus of which a socket and an input pin is bound is an error
// /brick/two_masters at the end of the elaboration; its output pins show its cycles either way.
//  - The annotated delay is waited for, then the bus: its first clock after the call, the end of its cycle, as long as
//    /TA or IOCHRDY stretch that. An access returns with the delay 0 as the cycle's address is let go; its time and its
//    result depend on neither quantum nor engine. Accesses to one bus queue as those to a register socket do. No DMI.
//  - A process that is killed in its access leaves the cycle to go on to its end.
//  - Debug transport reads the dual-ported RAM (not through a window with pages), BCR and PCTL, and moves 0 bytes of
//    anything else; it writes nothing.
//   TLM_GENERIC_ERROR_RESPONSE  rst_n broke the cycle off or is low (Port A); IOCHRDY stayed low for more than 15.6 us
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/board.h>
#include <brick/servo_ic.h>

namespace brick::component {

struct BoardOptions {
  std::uint32_t fitted = 0x3;  // ICs: bit i = servo IC 0..9, 2*..9* (10..17), MACRO IC 0..3 (18..21)
  std::uint64_t seed = 0;      // of what the dual-ported RAM holds at power-on; 0: zero
};

// Motor side of one servo IC of the board; the names of its ports begin with those of the IC, servo_ic0_ch1_enc_a.
struct BoardServoIc : ServoIcSerialPins {
  BoardServoIc(Component& board, const std::string& ic);
  std::array<ServoIcChannel, 4> ch;
};

// Of its pins: rst_n let go of, the board works 6 to 8 ticks later (host-bus:2.6); `fitted` takes away of what
// BoardOptions::fitted builds, and idles at all of it.
class Board final : public Component, public BoardPins {
 public:
  // An error /brick/fitted when BoardOptions::fitted has other bits than 0..21.
  Board(const sc_core::sc_module_name& name, TimeBase& time, const BoardOptions& options = {},
        const Engine& engine = model_engine());

  // Port A, the CPU's external bus (host-bus:2): PMAC word X:a is 4 bytes at 8 a + 4, Y:a at 8 a, 24 bits in the low
  // ones. Here too are the on-chip registers of the bus: BCR, X:$FFFFFB, wait states, and PCTL, X:$FFFFFD, the CPU
  // clock. They start as after a reset (rst_n), with the longest cycles.
  //   TLM_ADDRESS_ERROR_RESPONSE  nothing on the bus there (docs/architecture.md), or not a multiple of 4
  //   TLM_BURST_ERROR_RESPONSE, TLM_BYTE_ENABLE_ERROR_RESPONSE  not one whole word
  tlm_utils::simple_target_socket_optional<Board> port_a{"port_a"};

  // ISA / PC104 (host-bus:3.4): bytes of I/O, $0 to $FFFF, and of memory, $0 to $FFFFFF. An access of any length is
  // split into cycles: of a byte for I/O, of an aligned word or a byte for memory; in a slot of 8 bits, or where
  // MEMCS16# does not answer, of bytes. Bytes that are not enabled are not accessed. A lane that nobody drives reads
  // $FF.
  //   TLM_ADDRESS_ERROR_RESPONSE  beyond the last byte
  //   TLM_BURST_ERROR_RESPONSE    no byte, or no streaming width
  tlm_utils::simple_target_socket_optional<Board> isa_io{"isa_io"}, isa_memory{"isa_memory"};

  std::vector<std::unique_ptr<BoardServoIc>> servo_ic;  // the fitted ones, lowest first

  static const std::vector<PinInfo>& pin_table(std::uint32_t fitted);

 private:
  class IsaBus;
  void end_of_elaboration() override;
  void transport_port_a(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_io(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_memory(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  void transport_isa(bool memory, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned debug_port_a(tlm::tlm_generic_payload& payload);
  unsigned debug_memory(tlm::tlm_generic_payload& payload);
};

}  // namespace brick::component
