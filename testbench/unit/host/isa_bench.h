// ISA slave under test: both twins, and host cycles with tick resolution. The blocks behind it are played by the test:
// the host port answers 0xA0 + address, the interrupt controller 0xB0 + address.
#pragma once

#include <random>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/host/answered_isa_slave.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {

class IsaBench {
 public:
  using Inputs = AnsweredIsaSlave::Inputs;

  // `on_a_board`: as a board has it, which takes no notice of the ends of most reads (systemc/host/isa_slave.h).
  explicit IsaBench(bool on_a_board = false)
      : model(sc_core::sc_gen_unique_name("isa_slave")),
        both(make_rtl_isa_slave(on_a_board), model, on_a_board ? show_on_a_board : show) {
    if (on_a_board) model.leave_ends_out();
    both.ticks(12);  // switches are taken over, the bus is idle
  }

  static Outputs show(const AnsweredIsaSlave& block) {
    const IsaSlave& m = block.slave();
    return Outputs{{"isa_sd", m.isa_sd()},
                   {"isa_iochrdy", m.isa_iochrdy()},
                   {"isa_memcs16_n", m.isa_memcs16_n()},
                   {"isa_sd_oe", m.isa_sd_oe()},
                   {"host_reset", m.host_reset()},
                   {"pic_rd", m.pic_rd()},
                   {"hp_sel", m.hp_sel()},
                   {"hp_rd", m.hp_rd()},
                   {"hp_rd_done", m.hp_rd_done()},
                   {"hp_wr", m.hp_wr()},
                   {"hp_addr", m.hp_addr()},
                   {"hp_wdata", m.hp_wdata()},
                   {"pic_sel", m.pic_sel()},
                   {"pic_wr", m.pic_wr()},
                   {"pic_addr", m.pic_addr()},
                   {"pic_wdata", m.pic_wdata()},
                   {"mem_sel", m.mem_sel()},
                   {"mem_rd", m.mem_rd()},
                   {"mem_wr", m.mem_wr()},
                   {"mem_addr", m.mem_addr()},
                   {"mem_be", m.mem_be()},
                   {"mem_wdata", m.mem_wdata()}};
  }
  static Outputs show_on_a_board(const AnsweredIsaSlave& m) { return seen_by_a_board(show(m)); }

  AnsweredIsaSlave model;
  Lockstep<AnsweredIsaSlave> both;

  // What a block behind the slave saw at a clk_ref edge.
  struct Strobe {
    std::string what;
    unsigned addr, data;
    friend std::ostream& operator<<(std::ostream& out, const Strobe& s) {
      return out << s.what << " " << std::hex << s.addr << " " << s.data << std::dec;
    }
    bool operator==(const Strobe& o) const { return what == o.what && addr == o.addr && data == o.data; }
  };
  std::vector<Strobe> strobes;
  std::uint8_t port = 0xA0;  // what the host port shows at +0
  std::uint8_t pic = 0xB0;   // and the interrupt controller at +8

  void tick() {
    both.in.hp_rdata = static_cast<std::uint8_t>(port + both.get("hp_addr"));
    both.in.pic_rdata = static_cast<std::uint8_t>(pic + both.get("pic_addr"));
    if (is_ref_edge(both.now() + 1)) {  // the edge about to come sees them
      if (both.get("hp_wr")) strobes.push_back({"hp_wr", both.get("hp_addr"), both.get("hp_wdata")});
      if (both.get("hp_rd_done")) strobes.push_back({"hp_rd", both.get("hp_addr"), 0});
      if (both.get("pic_rd")) strobes.push_back({"pic_rd", both.get("pic_addr"), 0});
      if (both.get("pic_wr") && both.get("pic_sel"))
        strobes.push_back({"pic_wr", both.get("pic_addr"), both.get("pic_wdata")});
      if (both.get("mem_wr"))
        strobes.push_back({"mem_wr", both.get("mem_addr"), both.get("mem_wdata") | both.get("mem_be") << 16});
    }
    both.tick();
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }

  // Whole cycles: address 91 ns before the command (11 ticks), I/O command 530 ns (63 ticks), memory 240 ns (28 ticks),
  // hold 25 ns (3 ticks), then the pins hold something else.
  std::uint16_t io_read(unsigned address) { return cycle(address, &Inputs::isa_ior_n, 63, 0); }
  void io_write(unsigned address, unsigned value) { cycle(address, &Inputs::isa_iow_n, 63, value); }
  std::uint16_t mem_read(unsigned address) { return cycle(address, &Inputs::isa_memr_n, 28, 0); }
  void mem_write(unsigned address, unsigned value) { cycle(address, &Inputs::isa_memw_n, 28, value); }

  void set_address(unsigned address) {
    both.in.isa_sa = address & 0xFFFFF;
    both.in.isa_la = static_cast<std::uint8_t>(address >> 17);
  }
  // What a host finds on the bus: lanes that nobody drives are pulled up.
  unsigned bus_data() {
    const unsigned oe = both.get("isa_sd_oe");
    return both.get("isa_sd") | ((oe & 1) != 0 ? 0u : 0x00FFu) | ((oe & 2) != 0 ? 0u : 0xFF00u);
  }

  std::uint16_t cycle(unsigned address, bool Inputs::*command, int width, unsigned value) {
    set_address(address);
    both.in.isa_sd = static_cast<std::uint16_t>(value);
    ticks(11);
    both.in.*command = false;
    ticks(width);
    const auto data = static_cast<std::uint16_t>(bus_data());
    both.in.*command = true;
    ticks(3);
    both.in.isa_sd = static_cast<std::uint16_t>(~value);
    set_address(~address);
    ticks(12);
    return data;
  }

  void choose_straps(std::mt19937& random) {
    auto& in = both.in;
    in.io_base = random() % 2 ? 0x21 : static_cast<std::uint8_t>(random());
    in.io_decode16 = random() % 4 != 0;
    in.window = random() % 2 ? 0x35 : static_cast<std::uint16_t>(random() % 0x400);
    in.window_flat = random() % 2;
    in.slot8 = random() % 4 == 0;
  }

  void random_run(unsigned seed, int ticks) {
    std::mt19937 random(random_seed(seed));
    both.lazy = seed % 2;
    int left = 5;
    bool low = false;
    bool Inputs::*const commands[] = {&Inputs::isa_ior_n, &Inputs::isa_iow_n, &Inputs::isa_memr_n, &Inputs::isa_memw_n};
    for (int i = 0; i < ticks && both.difference().empty(); ++i) {
      auto& in = both.in;
      if (--left <= 0) {
        for (const auto command : commands) in.*command = true;
        low = !low;
        if (low) {
          in.*commands[random() % 4] = false;
          if (random() % 50 == 0) in.*commands[random() % 4] = false;  // no host does this; both must still agree
        } else {
          const unsigned io = unsigned{in.io_base} << 4 | random() % 16, memory = in.window << 14 | random() % 0x10000;
          unsigned address = random() % 4 ? io : memory;
          if (random() % 16 == 0) address ^= 1u << random() % 24;
          set_address(address);
          in.isa_sd = static_cast<std::uint16_t>(random());
          in.isa_aen = random() % 8 == 0;
          in.isa_sbhe_n = random() % 2;
        }
        left = 1 + static_cast<int>(random() % 24);
        if (random() % 100 == 0)
          in.isa_resetdrv = !in.isa_resetdrv;
        else if (in.isa_resetdrv && random() % 4 == 0)
          in.isa_resetdrv = false;
        if (random() % 60 == 0) choose_straps(random);
        if (random() % 200 == 0) both.reset();
      }
      if (random() % 64 == 0) in.isa_la = static_cast<std::uint8_t>(random() % 0x80);  // a host may let go of it early
      // The memory rests while it is not asked, but for a while in between.
      if (both.now() % kTicksPerRef == 0 && (both.get("mem_sel") != 0 || both.now() % 1000 < 100)) {
        in.mem_busy_d = random() % 3 == 0;  // also at the end of a command, when it has no part in it any more
        in.mem_rdata = static_cast<std::uint16_t>(random());
      }
      tick();
    }
  }
};

}  // namespace brick
