#include "testbench/plant/encoder.h"

#include <array>
#include <stdexcept>

namespace brick::plant {
namespace {

constexpr std::int64_t kU1 = kUnitsPerCount, kCycle = 4 * kUnitsPerCount;

std::vector<bool> set_of(const std::vector<unsigned>& members, unsigned size) {
  std::vector<bool> set(size, false);
  for (unsigned m : members) set.at(m) = true;
  return set;
}

std::int64_t modulo(std::int64_t a, std::int64_t b) {
  const std::int64_t rest = a % b;
  return rest < 0 ? rest + b : rest;
}

}  // namespace

Encoder::Encoder(const EncoderParameters& parameters)
    : par_(parameters),
      revolution_(kCycle * parameters.lines),
      dark_(set_of(parameters.dark_lines, parameters.lines)),
      joint_(set_of(parameters.joint_lines, parameters.lines)) {
  const auto small = [](std::int64_t x) { return x > -kU1 && x < kU1; };
  if (par_.lines == 0) throw std::invalid_argument("encoder: no lines");
  if (par_.index_width < 1 || par_.index_width > 4)
    throw std::invalid_argument("encoder: the index is 1 to 4 counts wide");
  if (!small(par_.b_late) || !small(par_.a_long))
    throw std::invalid_argument("encoder: an edge is off by a count or more");
  using Wiring = EncoderParameters::Wiring;
  const bool halls = par_.wiring == Wiring::kHalls || par_.wiring == Wiring::kHallsOnAbc;
  if (halls && par_.pole_pairs == 0) throw std::invalid_argument("encoder: halls need pole pairs");

  if (halls) grids_.push_back({par_.hall_offset, revolution_, 6 * std::int64_t{par_.pole_pairs}});
  if (par_.wiring == Wiring::kHallsOnAbc) return;
  whole_counts_ = par_.b_late == 0 && par_.a_long == 0;
  if (whole_counts_) {  // every edge is the begin of a count
    grids_.push_back({0, kU1, 1});
    return;
  }
  for (std::int64_t edge : {kU1, 3 * kU1 + par_.a_long, 2 * kU1 + par_.b_late, 4 * kU1 + par_.b_late})
    grids_.push_back({edge, kCycle, 1});
  const std::int64_t index = kU1 * par_.index_at;
  grids_.push_back({index, revolution_, 1});
  grids_.push_back({index + kU1 * par_.index_width, revolution_, 1});
}

bool Encoder::inside(std::int64_t position, std::int64_t from, std::int64_t width, std::int64_t period) const {
  return modulo(position - from, period) < width;
}

// The order that counts up in decode mode 11: 001 011 010 110 100 101.
unsigned Encoder::halls(std::int64_t position) const {
  constexpr std::array<unsigned, 6> kOrder{1, 3, 2, 6, 4, 5};
  const PositionGrid& sectors = grids_.front();
  return kOrder[static_cast<std::size_t>(modulo(sectors.index(position), 6))];
}

std::uint16_t Encoder::pins(std::int64_t position) const {
  using Wiring = EncoderParameters::Wiring;
  unsigned pins = kIdleChannelPins & kPins;
  const auto put = [&pins](unsigned pin, bool level) {
    pins = (pins & ~(1u << pin)) | static_cast<unsigned>(level) << pin;
  };

  if (par_.wiring == Wiring::kHallsOnAbc) {
    const unsigned h = halls(position);
    put(kEncA, (h & 4) != 0);
    put(kEncB, (h & 2) != 0);
    put(kEncC, (h & 1) != 0);
  } else {
    const std::int64_t place = modulo(position, kCycle);
    const auto line = static_cast<std::size_t>(modulo(position, revolution_) / kCycle);
    const bool a = place >= kU1 && place < 3 * kU1 + par_.a_long && !dark_[line];
    const bool b_early = joint_[line] && place >= kU1 && place < 2 * kU1 + par_.b_late;
    const bool b = inside(position, 2 * kU1 + par_.b_late, 2 * kU1, kCycle) || b_early;
    put(kEncA, a);
    put(kEncB, b);
    put(kEncC, inside(position, kU1 * par_.index_at, kU1 * par_.index_width, revolution_));
    if (par_.wiring == Wiring::kComplements) {
      put(kU, a);
      put(kT, !a);
      put(kV, b);
      put(kW, !b);
    }
  }
  if (par_.wiring == Wiring::kHalls) {
    const unsigned h = halls(position);
    put(kU, (h & 4) != 0);
    put(kV, (h & 2) != 0);
    put(kW, (h & 1) != 0);
  }
  return static_cast<std::uint16_t>((pins & ~unsigned{cut_}) | (kIdleChannelPins & cut_));
}

}  // namespace brick::plant
