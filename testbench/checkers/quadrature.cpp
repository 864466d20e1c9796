#include "testbench/checkers/quadrature.h"

#include <algorithm>
#include <string_view>

namespace brick {
namespace {

// Place of the lines in a cycle of states written in the order that counts up, -1 when they are none of its states.
int place(std::string_view cycle, unsigned lines) {
  const auto at = cycle.find(static_cast<char>('0' + lines));
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

// Along {A,B} = 00, 10, 11, 01 with A in bit 0: lines 0, 1, 3, 2. Hall {A,B,C} = 001, 011, 010, 110, 100, 101 with A in
// bit 0.
constexpr std::string_view kQuadrature = "0132", kHall = "462315";

// 1 next, -1 previous, 0 the same, 2 anything else.
int move(std::string_view cycle, unsigned from, unsigned to) {
  const int a = place(cycle, from), b = place(cycle, to), n = static_cast<int>(cycle.size());
  if (a < 0 || b < 0) return 2;
  if (a == b) return 0;
  return b == (a + 1) % n ? 1 : a == (b + 1) % n ? -1 : 2;
}

}  // namespace

bool Quadrature::illegal() const { return (mode == 11 || mode == 15) && place(kHall, last_ & 7) < 0; }

int Quadrature::decode(std::uint16_t level) {
  const unsigned ab = level & 3, last = last_ & 3;
  const int sign = (mode & 4) != 0 ? -1 : 1;
  switch (mode) {
    case 0:
    case 4:  // pulse on A, direction on B
      return (last & 1) == 0 && (ab & 1) != 0 ? ((ab & 2) != 0 ? sign : -sign) : 0;
    case 1:
    case 2:
    case 3:
    case 5:
    case 6:
    case 7: {
      const int m = move(kQuadrature, last, ab);
      if (m == 2) {
        error_ = true;
        return 0;
      }
      const unsigned factor = mode & 3;                     // 1, 2, 3: x1, x2, x4
      if (factor == 1 && ((last | ab) & 2) != 0) return 0;  // only between 00 and 10
      if (factor == 2 && ((last ^ ab) & 1) == 0) return 0;  // only changes of A
      return sign * m;
    }
    case 11:
    case 15: {
      const int m = move(kHall, last_ & 7, level & 7);
      if (place(kHall, level & 7) < 0 || (m == 2 && place(kHall, last_ & 7) >= 0)) error_ = true;
      return m == 2 ? 0 : sign * m;
    }
    default:
      return 0;
  }
}

int Quadrature::count(std::int64_t k, int direction) {
  if (direction == 0) return 0;
  const bool down = direction < 0;
  reversed_ = down != down_;
  down_ = down;
  t1_ = static_cast<std::uint32_t>(std::min<std::int64_t>(k - last_count_, kSaturated));
  last_count_ = k;
  ++counts_;
  counter_ = (counter_ + direction) & 0xFFFFFF;
  return direction;
}

int Quadrature::step(std::int64_t k, std::uint16_t level) {
  const int direction = decode(level);
  last_ = level;
  if (hold) {
    counter_ = 0;
    error_ = false;
    return 0;
  }
  return count(k, wrong ? -direction : direction);
}

}  // namespace brick
