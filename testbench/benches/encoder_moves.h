// What the encoder bench plays on A, B and C: wheels and hall tracks that turn at random with glitches and jumps, or
// evenly.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "testbench/benches/channel_host.h"

namespace brick {

class EncoderMoves {
 public:
  static constexpr unsigned kA = 1u << kEncA, kB = 1u << kEncB, kC = 1u << kEncC;

  explicit EncoderMoves(ChannelHost& host) : host_(host) {}

  // `steps` at random for decode mode I7mn0 = `mode`, from `pins` on.
  std::vector<ChannelHost::Hold> random(unsigned mode, std::uint16_t pins, unsigned steps) {
    std::vector<ChannelHost::Hold> holds;
    bool up = host_.pick(2) != 0;
    const Tick sclk = host_.period();
    for (unsigned i = 0; i < steps; ++i) {
      if (i == steps / 2) holds.push_back({pins = jump(mode, pins), 4 * sclk});  // one that no filter takes away
      if (host_.pick(6) == 0) {  // a pulse on one line, shorter than two samples or not
        const unsigned line = 1u << host_.pick(3);
        holds.push_back({static_cast<std::uint16_t>(pins ^ line), 1 + host_.pick(static_cast<unsigned>(2 * sclk))});
        holds.push_back({pins, 1 + host_.pick(static_cast<unsigned>(4 * sclk))});
      }
      pins = next_pins(mode, pins, up);
      holds.push_back({pins, sclk + host_.pick(static_cast<unsigned>(4 * sclk))});
    }
    holds.push_back({pins, 4 * sclk});
    return holds;
  }

  // `steps` of a wheel, one every `sclk` SCLK periods.
  std::vector<ChannelHost::Hold> even(std::uint16_t pins, unsigned steps, bool a_leads, Tick sclk) const {
    std::vector<ChannelHost::Hold> holds{{pins, host_.period()}};
    for (unsigned i = 0; i < steps; ++i) {
      pins = wheel_step(pins, a_leads);
      holds.push_back({pins, sclk * host_.period()});
    }
    return holds;
  }

 private:
  // Where no step leads: both lines of a wheel, or no state of the hall lines.
  static std::uint16_t jump(unsigned mode, std::uint16_t pins) {
    if (mode != 11 && mode != 15) return pins ^ (kA | kB);
    return static_cast<std::uint16_t>(pins & ~(kA | kB | kC));
  }

  // One step of a wheel: mostly on, sometimes back, sometimes a jump.
  std::uint16_t next_pins(unsigned mode, std::uint16_t pins, bool& up) {
    static constexpr std::array<unsigned, 4> kWheel{0, kA, kA | kB, kB};
    static constexpr std::array<unsigned, 6> kHalls{kC, kB | kC, kB, kA | kB, kA, kA | kC};
    const unsigned chance = host_.pick(100);
    if (chance < 10) up = !up;
    if (mode == 11 || mode == 15) {
      constexpr unsigned kAll = kA | kB | kC;
      if (chance >= 97) return static_cast<std::uint16_t>((pins & ~kAll) | (host_.pick(2) != 0 ? kAll : 0));
      const auto at = std::find(kHalls.begin(), kHalls.end(), pins & kAll);
      const auto place = at == kHalls.end() ? host_.pick(6) : static_cast<unsigned>(at - kHalls.begin());
      return static_cast<std::uint16_t>((pins & ~kAll) | kHalls[(place + (chance >= 94 ? 2 + host_.pick(3)
                                                                          : up         ? 1
                                                                                       : 5)) %
                                                                6]);
    }
    const auto place =
        static_cast<unsigned>(std::find(kWheel.begin(), kWheel.end(), pins & (kA | kB)) - kWheel.begin());
    return static_cast<std::uint16_t>((pins & ~(kA | kB)) | kWheel[(place + (chance >= 95 ? 2 : up ? 1 : 3)) % 4]);
  }

  ChannelHost& host_;
};

}  // namespace brick
