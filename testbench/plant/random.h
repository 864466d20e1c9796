// Random numbers of the plant. Only the generator is taken from the library, because the standard fixes its sequence;
// the distributions of the library differ from one implementation to the next. Each use has a stream of its own, so
// that one does not move the other.
#pragma once

#include <cstdint>
#include <random>

namespace brick::plant {

class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(seed) ^ mix(~stream)) {}

  // 0 .. n-1, every value equally likely; n > 0.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t excess = (UINT64_MAX % n + 1) % n;  // of 2^64 over the largest multiple of n
    std::uint64_t x;
    do x = engine_();
    while (x > UINT64_MAX - excess);
    return x % n;
  }
  // Both ends included.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(below(static_cast<std::uint64_t>(high - low) + 1));
  }
  // -peak .. peak with the mean 0, the likelihood falling off linearly.
  std::int64_t noise(std::int64_t peak) { return between(0, peak) - between(0, peak); }

 private:
  // splitmix64: neighbouring seeds shall not give related sequences.
  static std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15;
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9;
    x = (x ^ x >> 27) * 0x94D049BB133111EB;
    return x ^ x >> 31;
  }
  std::mt19937_64 engine_;
};

}  // namespace brick::plant
