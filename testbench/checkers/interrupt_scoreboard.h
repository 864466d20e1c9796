// What the interrupt controller shows after each edge of clk_ref, by host-bus:3.5 and host-bus:4.1 and from the
// outside: levels of the lines as the edges sample them, writes at the edges at which they take place. Lines and writes
// are given in the order of time; the shown bytes are asked for edge by edge.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/core/ticks.h"

namespace brick {

class InterruptScoreboard {
 public:
  struct Shown {
    std::uint8_t ist = 0, sig = 0;
    bool irq = false;
    bool operator==(const Shown& o) const { return ist == o.ist && sig == o.sig && irq == o.irq; }
  };
  struct Write {
    bool mask = false, edge_level = false, clear = false;
    std::uint8_t value = 0;
  };

  // The next edge: what it samples, and the write that takes place there.
  Shown edge(std::uint8_t lines, const Write& write) {
    // The detector compares what was sampled two and three edges ago.
    for (unsigned n = 0; n < 8; ++n) {
      const bool rose = bit(sampled_[1], n) && !bit(sampled_[2], n);
      Line& line = lines_[n];
      if (write.clear || !bit(mask_, n)) line.latched = false;
      if (rose && bit(mask_, n) && !bit(edge_level_, n)) line.latched = true, ++edges_;
    }
    const std::uint8_t level = sampled_[1];  // IRQ shows a line by level an edge after SIG
    sampled_ = {lines, sampled_[0], sampled_[1]};
    if (write.mask) mask_ = write.value;
    if (write.edge_level) edge_level_ = write.value;

    Shown shown;
    shown.sig = sampled_[1];
    for (unsigned n = 0; n < 8; ++n) {
      const bool active = bit(edge_level_, n) ? bit(shown.sig, n) : lines_[n].latched;
      if (active && bit(mask_, n)) shown.ist = static_cast<std::uint8_t>(shown.ist | 1u << n);
    }
    bool asks = false;
    for (unsigned n = 0; n < 8; ++n)
      asks = asks || (bit(mask_, n) && (bit(edge_level_, n) ? bit(level, n) : lines_[n].latched));
    // IRQ has been low for kLow edges before it rises; a clear pulls it down.
    shown.irq = asks && !write.clear && (irq_ || low_ >= kLow);
    low_ = shown.irq ? 0 : low_ + 1;
    irq_ = shown.irq;
    return shown;
  }
  unsigned edges() const { return edges_; }  // taken

 private:
  struct Line {
    bool latched = false;
  };
  static bool bit(std::uint8_t byte, unsigned n) { return (byte >> n & 1) != 0; }

  static constexpr unsigned kLow = 4;

  std::array<Line, 8> lines_{};
  bool irq_ = false;
  unsigned low_ = kLow;                    // edges after which IRQ was low
  std::array<std::uint8_t, 3> sampled_{};  // by the last edge, the one before, and the one before that
  std::uint8_t mask_ = 0, edge_level_ = 0;
  unsigned edges_ = 0;
};

}  // namespace brick
