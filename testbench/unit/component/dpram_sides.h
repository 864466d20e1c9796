// The dual-ported RAM inside, its two sides driven as the rules of docs/components.md have their cycles.
#pragma once

#include "systemc/host/dpram.h"
#include "testbench/unit/component/sides.h"

namespace brick::component {

class DpramSides final : public Sides {
 public:
  explicit DpramSides(std::uint64_t seed);

  void set(const std::string& pin, std::uint32_t value) override;
  void edge(Tick t) override;
  bool moved() override;
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"busy_host", ram_.host_busy()}, {"busy_cpu", ram_.cpu_busy()}};
  }
  bool clocked(unsigned side, Tick t) const override { return side == kCpu || is_ref_edge(t); }
  void begin(unsigned side, const Access& access) override;
  void before(unsigned side) override;
  std::optional<std::uint32_t> after(unsigned side) override;

  static constexpr unsigned kHost = 0, kCpu = 1;

 private:
  // One word of the host's bytes.
  struct Word {
    unsigned index, lanes, place;  // place: byte of the access that lane 0 would be, less 1
    std::uint16_t value;
  };
  std::optional<std::uint32_t> host_after();
  std::optional<std::uint32_t> cpu_after();
  void next_word();

  brick::Dpram ram_;
  bool reset_ = false;
  Tick now_ = 0;
  unsigned shown_ = 0;
  // host
  Access host_{};
  std::vector<Word> words_;
  enum { kSeen, kAsks, kWrites } step_ = kSeen;
  std::uint32_t host_value_ = 0;
  // CPU
  Access cpu_{};
  unsigned high_ = 0;  // edges since the end of its strobe
  std::uint32_t cpu_value_ = 0;
};

Traffic dpram_traffic(std::uint32_t seed, Tick ticks);

}  // namespace brick::component
