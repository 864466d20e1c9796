// One channel with an encoder at its wires, on either engine; its clock's edges are written down.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "testbench/plant/ssi_encoder.h"
#include "testbench/unit/ssi/ssi_rig.h"

namespace brick {

using plant::SsiEncoder;
using plant::SsiEncoderParameters;
using Parity = SsiEncoderParameters::Parity;

inline constexpr Tick kRest = 2360;             // 20 us
inline constexpr Tick kLongestFrame = 200'000;  // more than any of these tests asks for, 1.7 ms
inline constexpr unsigned kGeoResult[] = {0x14, 0x34}, kGeoClock = 0x15, kGeoRefused[] = {0x16, 0x36};
constexpr unsigned brick_word(unsigned channel) { return 0x20 + 4 * (channel - 1); }
constexpr unsigned brick_group(unsigned channel) { return channel <= 4 ? 0x2F : 0x3F; }

class SsiNames {
 public:
  template <class T>
  static std::string GetName(int i) {
    return i == 0 ? "Rtl" : "Model";
  }
};

template <class Rig>
class SsiOn : public ::testing::Test {
 protected:
  // An encoder at channel n; its clock's edges are written down.
  void wire(unsigned channel, const SsiEncoderParameters& parameters, std::uint64_t position) {
    encoder.emplace(parameters, 1, 1);
    edges.clear();
    bool last = true;
    rig.encoders = [=, this_ = this](Tick now, unsigned clk) mutable {
      const bool level = (clk >> (channel - 1) & 1) != 0;
      if (level != last) {
        this_->edges.push_back(now);
        this_->encoder->clock(now, level, position);
        last = level;
      }
      const unsigned others = 0xFFu & ~(1u << (channel - 1));
      return others | (this_->encoder->level(now) ? 1u : 0u) << (channel - 1);
    };
  }
  void frame_over() {
    const Tick limit = rig.now() + kLongestFrame;
    Tick quiet = 0;
    for (std::size_t seen = edges.size(); quiet < kRest + 20; ++quiet) {
      if (rig.now() > limit) {
        ADD_FAILURE() << "the clock does not come to rest";
        return;
      }
      rig.run(1);
      if (edges.size() != seen || edges.size() % 2 != 0) quiet = 0;
      seen = edges.size();
    }
  }
  // Triggers at a fall of SERVO; returns the tick whose edge sees it.
  Tick trigger() {
    const Tick seen = rig.now() + 1;
    rig.trigger();
    return seen;
  }

  SsiBench<Rig> rig;
  std::optional<SsiEncoder> encoder;
  std::vector<Tick> edges;
};
using SsiEngines = ::testing::Types<RtlSsiRig, ModelSsiRig>;

}  // namespace brick
