// The host of the bench `interrupts`: drives every line there is, ends write cycles at chosen ticks, and knows when
// pins moved.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/bench.h"
#include "rtl/regs/brick_regs.hpp"
#include "systemc/machine/board_family.h"

namespace brick {

class InterruptHost {
 public:
  using Edit = std::function<void(HostInputs&)>;

  explicit InterruptHost(BenchContext& context) : b(context), random_(context.seed) {}

  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }

  // IR0 to IR4 in turn.
  static constexpr std::array<const char*, 5> kFixed{"IPOS", "BREQ", "EROR", "F1ER", "HREQ"};
  void drive_fixed(unsigned n, bool level) {
    if (n < 4)
      b.ask(fmt::format("WX$70010,{}", level ? 1u << n : 0u));
    else
      b.bus.io_write(regs::host_io::kIcr, level ? regs::host_io::icr::kTreq.mask() : 0);
  }

  // Sources of IR5 to IR7 that this board has but for WDO, as codes of line_select: each of them stands on any line
  // here.
  std::vector<unsigned> sources() const {
    std::vector<unsigned> codes;
    for (unsigned code = 1; code < kInterruptSources.size(); ++code) {
      if (code == kSourceWdo) continue;
      if (code <= kSourceEqu8 && (b.board.fitted >> (code - 1) / 4 & 1) == 0) continue;
      codes.push_back(code);
    }
    return codes;
  }
  void drive(unsigned source, bool level) {
    if (source <= kSourceEqu8) {  // EQU by hand: bits 11 and 12 of the channel's control word
      const unsigned n = source - 1;
      b.ask(fmt::format("WX${:X},{}", regs::kGateIcs[n / 4].base + 8 * (n % 4) + 5, level ? 0x1800 : 0x0800));
    } else if (source < kSourceMi1) {
      b.ask(fmt::format("WX$70012,{}", level ? 1u << (source - kSourceCtrl0) : 0u));
    } else {
      b.machine.inputs().*kOutside[source - kSourceMi1] = level;
      b.machine.apply();
    }
    b.bus.wait(40);
  }
  void select(unsigned ir5, unsigned ir6, unsigned ir7) {
    b.machine.inputs().line_select = static_cast<std::uint16_t>(ir5 | ir6 << 4 | ir7 << 8);
    b.machine.apply();
    b.bus.wait(40);
  }

  // Edits of the pins at ticks, in any order; the edge after the tick is the first to see one.
  void play(std::vector<std::pair<Tick, Edit>> edits) {
    std::stable_sort(edits.begin(), edits.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    for (const auto& [tick, edit] : edits) {
      b.bus.advance_to(tick);
      edit(b.machine.inputs());
      b.machine.apply();
    }
  }
  // A write cycle whose command ends at tick `end`, 80 ticks or more from now.
  static void add_write(std::vector<std::pair<Tick, Edit>>& edits, Tick end, unsigned offset, std::uint8_t value) {
    edits.emplace_back(end - 80, [=](HostInputs& in) {
      in.isa_sa = 16u * in.io_base + offset;
      in.isa_sd = value;
      in.isa_aen = false;
    });
    edits.emplace_back(end - 66, [](HostInputs& in) { in.isa_iow_n = false; });
    edits.emplace_back(end, [](HostInputs& in) { in.isa_iow_n = true; });
  }

  static constexpr bool HostInputs::*kOutside[] = {&HostInputs::mi1, &HostInputs::mi2, &HostInputs::axexp0,
                                                   &HostInputs::axexp1};
  BenchContext& b;

 private:
  std::mt19937_64 random_;
};

void interrupts_8259(BenchContext& b);  // the board has the other controller

}  // namespace brick
