// Bus cycles of all kinds in the CPU's place (BusMaster), at any clock and number of wait states: words of each region
// are written and read in random order, or at every phase that the CPU clock has to the board's. It knows what each
// word must hold, so a write that was lost is found too. The sweep of `brick timing` and the bench bus-timing drive it.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"
#include "testbench/checkers/timing_port_a.h"

namespace brick {

class BusTraffic final : public BusMaster {
 public:
  using Region = PortATiming::Region;
  static constexpr unsigned kMultipliers = 32;
  static constexpr unsigned most_wait_states(Region region) { return region == Region::kDpram ? 7 : 31; }

  // Takes the bus of the machine until it goes; the CPU comes back with the next reset.
  BusTraffic(Machine& machine, std::uint64_t seed);
  ~BusTraffic() override;
  BusTraffic(const BusTraffic&) = delete;
  BusTraffic& operator=(const BusTraffic&) = delete;

  bool has(Region region) const { return !words_[region].empty(); }
  void set_clock(unsigned multiplier);               // I52 + 1
  void set_wait_states(Region region, unsigned ws);  // the other regions get the most they can have

  // `count` random accesses in the region. While they run `meanwhile` is called again and again: a host at work, which
  // may read the same words.
  void exercise(Region region, unsigned count, const std::function<void()>& meanwhile = {});

  // Reads and writes in all pairs, one at once after the other, the first of each at every phase of the CPU clock to
  // clk_ref, what moves within a nanosecond of an edge taken early, and late; the dual-ported RAM with a moving /TA
  // seen at once, and not: whatever the seed, the worst is among them. The number of accesses is returned.
  unsigned every_phase(Region region);
  // `count` accesses of one word of the dual-ported RAM that the host may write meanwhile: nobody knows what it holds.
  void share(unsigned count, const std::function<void()>& meanwhile);
  static constexpr std::uint32_t kSharedAddress = 0x060C10;                        // Y
  static constexpr std::uint32_t kSharedOffset = 4 * (kSharedAddress - 0x060000);  // of the host
  // Reads that gave another word than the last one written, since the last verify().
  unsigned wrong_reads() const { return wrong_reads_; }
  // Reads every word of the region back, with all the time there is: "" or what is wrong. Sets clock and wait states.
  std::string verify(Region region);

  std::optional<Access> next() override;
  void done(const Access& access, std::uint32_t data) override;

 private:
  struct Word {
    bool x;
    std::uint32_t address;
    std::uint32_t mask = 0, value = 0;  // bits that can be written, and what they hold
  };
  struct Queued : Access {
    bool judged = false;
    std::uint32_t mask = 0, value = 0;  // of a read that is judged
  };
  void finish(const std::function<void()>& meanwhile = {});
  Queued access(Word& word, bool write, std::uint32_t value);
  void control(std::uint32_t address, std::uint32_t value);
  void another_phase();
  std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

  Machine& machine_;
  std::mt19937_64 random_;
  std::array<std::vector<Word>, PortATiming::kRegions> words_;
  std::deque<Queued> queue_;
  std::vector<std::uint32_t> read_;  // in order
  std::size_t under_way_ = 0;
  unsigned multiplier_ = 8, wrong_reads_ = 0;
};

}  // namespace brick
