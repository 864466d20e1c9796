// The encoder decoder and its counter as rules (servo-ic:5.4, servo-ic:5.5/1, servo-ic:5.5/2, servo-ic:5.6), one call
// an SCLK period with the filtered levels. Written from tables of legal neighbours, without knowledge of how the
// engines decode. Modes 8 and 12 are fed by pulse().
#pragma once

#include <cstdint>

namespace brick {

class Quadrature {
 public:
  static constexpr std::uint32_t kSaturated = 0x7FFFFF;

  bool hold = false;   // control bit 10: the counter stays 0, without error
  unsigned mode = 7;   // I7mn0
  bool wrong = false;  // deliberately wrong rule: the two directions are exchanged
  explicit Quadrature(std::uint16_t level) : last_(level) {}

  // `level` has A, B, C in bits 0, 1, 2; `k` numbers the SCLK periods. Returns the count: -1, 0 or 1.
  int step(std::int64_t k, std::uint16_t level);
  int count(std::int64_t k, int direction);  // a count from elsewhere: PFM pulse of mode 8

  std::int32_t counter() const { return (counter_ ^ 0x800000) - 0x800000; }  // 24 bits, signed
  std::uint32_t raw() const { return static_cast<std::uint32_t>(counter_); }
  bool down() const { return down_; }
  bool reversed() const { return reversed_; }
  bool error() const { return error_; }
  bool illegal() const;  // the cause of the error stands: hall lines that are no state
  std::uint32_t t1() const { return t1_; }
  unsigned counts() const { return counts_; }  // since the last clear(); T1 means something from the second on
  std::int64_t last_count() const { return last_count_; }
  void clear_error() { error_ = illegal(); }
  void clear_timing() { counts_ = 0; }

 private:
  int decode(std::uint16_t level);
  std::uint16_t last_;
  std::int32_t counter_ = 0;
  bool down_ = false, reversed_ = false, error_ = false;
  std::uint32_t t1_ = 0;
  std::int64_t last_count_ = 0;
  unsigned counts_ = 0;
};

}  // namespace brick
