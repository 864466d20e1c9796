#include "testbench/unit/component/dpram_sides.h"

#include "systemc/board/bus_strobes.h"
#include "systemc/core/start_value.h"
#include "testbench/unit/random_seed.h"

namespace brick::component {

DpramSides::DpramSides(std::uint64_t seed) : ram_("block") {
  for (unsigned i = 0; i < 32768; ++i) ram_.poke(i, start_word(start_seed(seed), i));
  ram_.reset(0);
}

void DpramSides::set(const std::string& pin, std::uint32_t value) {
  if (pin == "small") ram_.in.small = value != 0;
  if (pin == "rst_n") reset_ = value == 0;
  if (reset_) {
    ram_.in.rd_falls = ram_.in.wr_falls = 0;  // flip-flops that the strobes clock
    ram_.reset(now_);
  }
}

void DpramSides::edge(Tick t) {
  now_ = t;
  if (reset_)
    ram_.reset(t);
  else
    ram_.advance(t);
}

bool DpramSides::moved() {
  const unsigned before = shown_;
  shown_ = ram_.host_busy() | ram_.cpu_busy() << 1;
  return shown_ != before;
}

void DpramSides::begin(unsigned side, const Access& access) {
  if (side == kCpu) {
    cpu_ = access;
    high_ = 0;
    return;
  }
  host_ = access;
  host_value_ = access.value;
  if (access.length < 4) host_value_ &= (1u << 8 * access.length) - 1;
  words_.clear();
  for (unsigned i = 0; i < access.length; ++i) {
    if ((access.enables >> i & 1) == 0) continue;
    const unsigned at = access.address + i;
    if (words_.empty() || words_.back().index != at / 2) words_.push_back({at / 2, 0, i + 1 - at % 2, 0});
    words_.back().lanes |= 1u << at % 2;
    words_.back().value =
        static_cast<std::uint16_t>(words_.back().value | (access.value >> 8 * i & 0xFF) << 8 * (at % 2));
  }
  step_ = kSeen;
}

void DpramSides::before(unsigned side) {
  DpramInputs& in = ram_.in;
  if (reset_) return;
  if (side == kHost) {
    const Word& word = words_.front();
    in.mem_sel = step_ == kAsks;
    in.mem_wr = step_ == kWrites;
    in.mem_rd = !host_.write;
    in.mem_addr = static_cast<std::uint16_t>(word.index);
    in.mem_be = static_cast<std::uint8_t>(word.lanes);
    in.mem_wdata = word.value;
  } else if (high_ == 0) {
    in.cpu_sel = true;
    in.cpu_x = cpu_.address % 4 == 2;
    in.cpu_addr = static_cast<std::uint16_t>(cpu_.address / 4);
    in.cpu_wdata = static_cast<std::uint16_t>(cpu_.value);
    bool& strobe_n = cpu_.write ? in.cpu_wr_n : in.cpu_rd_n;
    std::uint8_t& falls = cpu_.write ? in.wr_falls : in.rd_falls;
    if (strobe_n) falls = next_fall(falls);  // it falls once
    strobe_n = false;
  }
}

std::optional<std::uint32_t> DpramSides::after(unsigned side) { return side == kHost ? host_after() : cpu_after(); }

std::optional<std::uint32_t> DpramSides::host_after() {
  DpramInputs& in = ram_.in;
  if (!reset_) {
    if (step_ == kSeen) {
      step_ = kAsks;
      return {};
    }
    if (step_ == kAsks && ram_.mem_busy()) return {};
    if (step_ == kAsks && host_.write) {
      step_ = kWrites;
      return {};
    }
  }
  in.mem_sel = in.mem_wr = false;
  const Word word = words_.front();
  if (!host_.write)
    for (unsigned lane = 0; lane < 2; ++lane)
      if ((word.lanes >> lane & 1) != 0) {
        const unsigned place = 8 * (word.place + lane - 1);
        const std::uint32_t byte = ram_.mem_rdata() >> 8 * lane & 0xFF;
        host_value_ = (host_value_ & ~(0xFFu << place)) | byte << place;
      }
  words_.erase(words_.begin());
  step_ = kSeen;
  if (!words_.empty()) return {};
  return host_value_;
}

std::optional<std::uint32_t> DpramSides::cpu_after() {
  DpramInputs& in = ram_.in;
  if (!reset_ && high_ == 0 && ram_.cpu_wait()) return {};
  if (high_ == 0) cpu_value_ = cpu_.write ? cpu_.value & 0xFFFF : ram_.cpu_rdata();
  in.cpu_rd_n = in.cpu_wr_n = true;
  ram_.rd_moved();
  if (!reset_ && ++high_ < 3) return {};
  in.cpu_sel = false;
  return cpu_value_;
}

Traffic dpram_traffic(std::uint32_t seed, Tick ticks) {
  Traffic traffic;
  traffic.end = edge_time(ticks);
  std::mt19937 random(random_seed(seed));
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::map<std::string, std::uint32_t> level{{"rst_n", 1}};
  const auto turn = [&](Picoseconds time, const std::string& pin) {
    traffic.pins.push_back({time, pin, level[pin] ^= 1});
  };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += 1'000 + below(80'000'000);
    if (below(3) == 0)
      turn(now, "small");
    else
      turn(now, "rst_n"), turn(now += 1 + below(60'000), "rst_n");
  }
  const auto idle = [&below](unsigned most) { return Picoseconds{below(4) == 0 ? 0 : below(most)}; };
  // Mostly four words, else anywhere, now and then beside the end of the small RAM or of the window.
  const auto address = [&below]() -> unsigned {
    const unsigned where = below(30);
    return where == 0 ? below(0xFFFC) : where == 1 ? 0x3FFC + below(8) : where == 2 ? 0xFFFC : below(8);
  };
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500) {
    Access a{idle(250'000), below(2) == 0, address(), static_cast<std::uint32_t>(random())};
    a.length = below(4) == 0 ? 1 + below(4) : a.address % 2 == 0 ? 2 : 1;
    if (below(5) == 0) {
      const unsigned some = below(1u << a.length);
      a.enables = some == 0 ? 1 : some;
    }
    traffic.accesses.push_back(a);
  }
  for (Picoseconds now = 0; now < traffic.end; now += traffic.others.back().idle + 5 * 8'500)
    traffic.others.push_back({idle(200'000), below(2) == 0, address() & ~1u, below(0x10000)});
  return traffic;
}

}  // namespace brick::component
