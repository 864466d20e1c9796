// The Verilated boards by the ICs that they are built with, smallest first. The fitted ICs choose the first that has
// them all. A bigger variant is one line here and one in CMakeLists.txt.
#include <Vboard_all.h>
#include <Vboard_all___024root.h>
#include <Vboard_s2.h>
#include <Vboard_s2___024root.h>
#include <Vboard_s4m1.h>
#include <Vboard_s4m1___024root.h>
#include <fmt/format.h>

#include "systemc/cosim/rtl_board.h"

namespace brick {

namespace {

struct Variant {
  std::uint32_t built;  // as BoardInputs::fitted
  std::unique_ptr<Board> (*make)(std::uint32_t fitted, const RtlOptions& options);
};

template <class Model>
std::unique_ptr<Board> make(std::uint32_t fitted, const RtlOptions& options) {
  return std::make_unique<RtlBoard<Model>>(fitted, options);
}

constexpr Variant kVariants[] = {
    {0x000003, make<Vboard_s2>},    // servo ICs 0, 1
    {0x04000F, make<Vboard_s4m1>},  // servo ICs 0..3, MACRO IC 0
    {0x3FFFFF, make<Vboard_all>},
};

}  // namespace

std::unique_ptr<Board> make_rtl_board(std::uint32_t fitted, const RtlOptions& options) {
  for (const Variant& v : kVariants)
    if ((fitted & ~v.built) == 0) return v.make(fitted, options);
  throw std::runtime_error(
      fmt::format("no Verilated board has all fitted ICs (mask ${:06X}); the largest one is built with ${:06X}: use "
                  "--engine systemc",
                  fitted, kVariants[std::size(kVariants) - 1].built));
}

}  // namespace brick
