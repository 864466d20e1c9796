// Dual-ported RAM under test: both twins; Port A strobes with tick resolution, host commands as isa_slave makes them.
#pragma once

#include <random>

#include "systemc/board/bus_strobes.h"
#include "systemc/host/dpram.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/host/lockstep.h"
#include "testbench/unit/random_seed.h"

namespace brick {

class DpramBench {
 public:
  explicit DpramBench(bool small = false, int seed = 0)
      : model("dpram"), both(make_rtl_dpram(seed), model, [](const Dpram& m) {
          return Outputs{{"cpu_rdata", m.cpu_rdata()}, {"cpu_wait", m.cpu_wait()},   {"cpu_busy", m.cpu_busy()},
                         {"mem_rdata", m.mem_rdata()}, {"host_busy", m.host_busy()}, {"cpu_drive", m.cpu_drive()}};
        }) {
    both.in.small = small;
  }

  Dpram model;
  Lockstep<Dpram> both;

  // The strobe falls before the next tick. `word` is host byte offset / 2 = 2(a - $060000) + (X ? 1 : 0).
  void cpu_start_read(unsigned word) { cpu_start(word, true, 0); }
  void cpu_start_write(unsigned word, unsigned value) { cpu_start(word, false, value); }
  void cpu_end() {
    both.in.cpu_rd_n = both.in.cpu_wr_n = true;
    both.in.cpu_sel = false;
    both.get("cpu_drive");  // the pins are high before a strobe falls again, though not for a tick
  }
  // Whole accesses without a competitor, and the time that their end takes to be seen.
  unsigned cpu_read(unsigned word) {
    cpu_start_read(word);
    both.ticks(kAccess);
    const unsigned value = both.get("cpu_rdata");
    cpu_end();
    both.ticks(kRest);
    return value;
  }
  void cpu_write(unsigned word, unsigned value) {
    cpu_start_write(word, value);
    both.ticks(kAccess);
    cpu_end();
    both.ticks(kRest);
  }
  // Of the CPU's strobe: the access takes place at the third edge after its fall; its end has come through two
  // flip-flops and a third after four.
  static constexpr int kAccess = 3, kRest = 4;

  // The request is seen by the next clk_ref edge.
  void host_start(unsigned word, bool read) {
    both.in.mem_sel = true;
    both.in.mem_rd = read;
    both.in.mem_addr = static_cast<std::uint16_t>(word);
  }
  void host_end_read() {
    both.in.mem_sel = false;
    both.ref();
  }
  void host_end_write(unsigned value, unsigned lanes = 3) {  // the write takes place at the next clk_ref edge
    both.in.mem_sel = false;
    both.in.mem_wr = true;
    both.in.mem_wdata = static_cast<std::uint16_t>(value);
    both.in.mem_be = static_cast<std::uint8_t>(lanes);
    both.ref();
    both.in.mem_wr = false;
  }
  unsigned host_read(unsigned word) {
    host_start(word, true);
    both.ref(2);
    const unsigned value = both.get("mem_rdata");
    host_end_read();
    return value;
  }
  void host_write(unsigned word, unsigned value, unsigned lanes = 3) {
    host_start(word, false);
    both.ref(2);
    host_end_write(value, lanes);
  }
  bool cpu_wait() { return both.get("cpu_wait"); }
  bool cpu_busy() { return both.get("cpu_busy"); }
  bool host_busy() { return both.get("host_busy"); }

  // Strobes and commands of random length on a few cells, so that they meet.
  void random_run(unsigned seed, int ticks, unsigned cells) {
    std::mt19937 random(random_seed(seed));
    both.lazy = seed % 2;
    int cpu_left = 3, host_left = 3;
    for (int i = 0; i < ticks && both.difference().empty(); ++i) {
      if (--cpu_left <= 0) {
        if (both.in.cpu_sel) {
          cpu_end();
        } else {
          cpu_start(random() % cells, random() % 2, random());
          if (random() % 10 == 0) both.in.cpu_sel = false;  // somebody else's access
        }
        cpu_left = 1 + static_cast<int>(random() % 8);
      }
      if (random() % 40 == 0)
        both.in.cpu_addr = random() % 2;  // no CPU does this during a strobe; both must still agree
      if (both.now() % kTicksPerRef == 0) {
        both.in.mem_wr = false;
        if (--host_left <= 0) {
          if (both.in.mem_sel) {
            both.in.mem_sel = false;
            both.in.mem_wr = !both.in.mem_rd;
            both.in.mem_wdata = static_cast<std::uint16_t>(random());
            both.in.mem_be = random() % 4;
          } else {
            host_start(random() % cells, random() % 2);
          }
          host_left = 1 + static_cast<int>(random() % 5);
        }
      }
      both.tick();
    }
  }

 private:
  void cpu_start(unsigned word, bool read, unsigned value) {
    both.in.cpu_sel = true;
    std::uint8_t& falls = read ? both.in.rd_falls : both.in.wr_falls;
    falls = next_fall(falls);
    both.in.cpu_addr = static_cast<std::uint16_t>(word / 2);
    both.in.cpu_x = word % 2;
    both.in.cpu_rd_n = !read;
    both.in.cpu_wr_n = read;
    both.in.cpu_wdata = static_cast<std::uint16_t>(value);
  }
};

}  // namespace brick
