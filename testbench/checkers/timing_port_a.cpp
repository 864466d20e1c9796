#include "testbench/checkers/timing_port_a.h"

#include <algorithm>

namespace brick {

namespace {

constexpr unsigned kWaitStates = 32, kMultipliers = 33;
constexpr unsigned k150MHz = 16;  // x 9.8304 MHz, the first that is not below

// host-bus:2.2, host-bus:2.5/6, host-bus:2.5/7, host-bus:2.5/9, host-bus:2.5/10, host-bus:2.6/6 to host-bus:2.6/8.
std::vector<TimingRule> port_a_rules() {
  constexpr auto kLeast = TimingRule::Kind::kLeast, kMost = TimingRule::Kind::kMost, kHolds = TimingRule::Kind::kHolds;
  return {{"100", "cycle: address and AA valid", "host-bus:2.2/100", kLeast},
          {"101", "address, AA valid to /WR low", "host-bus:2.2/101", kLeast},
          {"102", "/WR low", "host-bus:2.2/102", kLeast},
          {"103", "/WR high to address invalid", "host-bus:2.2/103", kLeast},
          {"104", "address, AA valid to read data valid", "host-bus:2.2/104", kMost},
          {"105", "/RD low to read data valid", "host-bus:2.2/105", kMost},
          {"106", "read data hold after /RD high", "host-bus:2.2/106", kLeast},
          {"107", "address valid to /WR high", "host-bus:2.2/107", kLeast},
          {"108", "write data valid to /WR high", "host-bus:2.2/108", kLeast},
          {"109", "write data hold after /WR high", "host-bus:2.2/109", kLeast},
          {"110", "/WR low to data driven", "host-bus:2.2/110", kLeast},
          {"111", "/WR high to data off", "host-bus:2.2/111", kMost},
          {"112", "last /RD high to data driven by a write", "host-bus:2.2/112", kLeast},
          {"113", "/RD high", "host-bus:2.2/113", kLeast},
          {"114", "/WR high", "host-bus:2.2/114", kLeast},
          {"115", "address valid to /RD low", "host-bus:2.2/115", kLeast},
          {"116", "/RD low", "host-bus:2.2/116", kLeast},
          {"117", "/RD high to address invalid", "host-bus:2.2/117", kLeast},
          {"118", "/TA set-up before /RD or /WR high", "host-bus:2.2/118", kLeast},
          {"119", "/TA hold after /RD or /WR high", "host-bus:2.2/119", kLeast},
          {"w1", "/WR low to write data valid", "host-bus:2.6/6", kMost},
          {"w2", "/WR low to address or write data invalid", "host-bus:2.6/7", kLeast},
          {"s1", "/RD or /WR low", "host-bus:2.6/8", kLeast},
          {"a", "/RD and /WR never low together", "host-bus:2.5/6", kHolds},
          {"b", "address, AA stand through the strobe", "host-bus:2.5/7", kHolds},
          {"c", "board lets go of D to CPU drives it", "host-bus:2.5/9", kLeast},
          {"d", "CPU lets go of D to board drives it", "host-bus:2.5/10", kLeast},
          {"e", "board drives D inside /RD only", "host-bus:2.6/5", kHolds},
          {"f", "two wait states or more from 150 MHz on", "host-bus:2.2/5", kHolds}};
}

// `quarters` quarters of TC; TC is 1/9.8304 MHz by the multiplier, a quarter of it 5^13 / (48 x multiplier) fs.
constexpr std::int64_t kQuarter = 1'220'703'125, kQuarterParts = 48;
TimeFs floor_quarters(std::int64_t quarters, unsigned multiplier) {
  const std::int64_t parts = kQuarterParts * multiplier, product = quarters * kQuarter;
  return product >= 0 ? product / parts : -((-product + parts - 1) / parts);
}
TimeFs ceil_quarters(std::int64_t quarters, unsigned multiplier) { return -floor_quarters(-quarters, multiplier); }

constexpr TimeFs tenths_ns(int tenths) { return tenths * (kFsPerNs / 10); }

// One of three values by the form: 1 to 3, 4 to 7, 8 and more wait states.
int by_form(unsigned ws, int to_3, int to_7, int from_8) { return ws <= 3 ? to_3 : ws <= 7 ? to_7 : from_8; }

}  // namespace

PortATiming::PortATiming()
    : ledger_("Port A", "XY", port_a_rules(), {"gate ICs AA1", "dual-ported RAM AA2", "default area"}),
      cache_(kWaitStates * kMultipliers) {}

// In quarters of TC and tenths of a nanosecond.
std::optional<TimeFs> PortATiming::required(Rule rule, const PortAConditions& at) {
  const unsigned ws = at.wait_states;
  const int clocks = static_cast<int>(ws + at.stretched);  // of what contains the strobe
  const auto least = [&](std::int64_t quarters, int tenths) {
    return floor_quarters(quarters, at.multiplier) + tenths_ns(tenths);
  };
  const auto most = [&](std::int64_t quarters, int tenths) {
    return ceil_quarters(quarters, at.multiplier) + tenths_ns(tenths);
  };
  // Rows without a form for one wait state, and all but the general ones without any for none.
  constexpr Rule kFromTwo[] = {k110, k111, k112, k113, k114, k117},
                 kGeneral[] = {k104, k105, k106, k107, k108, k115, k116};
  const auto one_of = [rule](const auto& list) {
    return std::find(std::begin(list), std::end(list), rule) != std::end(list);
  };
  if (ws == 0 ? !one_of(kGeneral) : ws == 1 && one_of(kFromTwo)) return std::nullopt;
  switch (rule) {
    case k100:
      return least(4 * (clocks + by_form(ws, 1, 2, 3)), -40);
    case k101:
      return least(ws == 1 ? 1 : ws <= 3 ? 3 : 5, -20);
    case k102:
      return least(4 * static_cast<int>(at.stretched) + (ws == 1 ? 6 : 4 * static_cast<int>(ws) - (ws <= 3 ? 0 : 2)),
                   -40);
    case k103:
    case k109:
      return least(by_form(ws, 1, 5, 9), -20);
    case k104:
      return most(4 * clocks + 3, -50);
    case k105:
      return most(4 * clocks + 1, -50);
    case k106:
    case k119:
      return 0;
    case k107:
      return least(4 * clocks + 3, -40);
    case k108:
      return least(4 * clocks - 1, -30);
    case k110:
      return least(ws <= 3 ? 1 : -1, -37);
    case k111:
      return most(by_form(ws, 1, 5, 9), 2);
    case k112:
      return least(by_form(ws, 5, 9, 13), -40);
    case k113:
      return least(by_form(ws, 7, 7, 11), -40);
    case k114:
      return least(by_form(ws, 8, 10, 14), -40);
    case k115:
      return least(2, -20);
    case k116:
      return least(4 * clocks + 1, -40);
    case k117:
      return least(by_form(ws, 5, 5, 9), -20);
    case k118:
      return least(1, 20);
    default:
      return std::nullopt;
  }
}

// Periods of clk_ref (three ticks) and of clk_pwm, a nanosecond for the flip-flop that misses or just catches an edge,
// and the most that one pin comes later than another.
std::optional<TimeFs> PortATiming::needed(Rule rule, Region region) {
  constexpr TimeFs kAperture = kFsPerNs, kPins = detail::kBlockFs / detail::kBlockTicks;
  constexpr Tick kRef = kTicksPerRef;
  switch (rule) {
    case kW1:
      return tick_to_fs(region == kDpram ? 2 : kRef) - kAperture - kPins;
    case kW2:
      if (region == kDpram) return std::nullopt;
      return tick_to_fs(2 * kRef) + kAperture + kPins;
    case kS1:
      if (region == kDpram) return std::nullopt;
      return tick_to_fs(2 * kRef) + kAperture;
    default:
      return std::nullopt;
  }
}

TimeFs PortATiming::quarters(std::int64_t count, unsigned multiplier) { return floor_quarters(count, multiplier); }

const PortATiming::Limits& PortATiming::limits(const PortAConditions& at) {
  const auto fill = [&at](Limits& all) -> const Limits& {
    for (unsigned r = 0; r <= k119; ++r) all.row[r] = required(static_cast<Rule>(r), at);
    return all;
  };
  if (at.stretched != 0) return fill(stretched_);
  auto& known = cache_[at.multiplier * kWaitStates + at.wait_states];
  return known ? *known : fill(known.emplace());
}

void PortATiming::cycle(const PinCycle& c) {
  region_ = region(c.aa);
  place_ = {c.start, c.address, c.x ? 'X' : 'Y', c.write, c.pc != 0, c.pc};
  place_.wait_states = c.wait_states;
  place_.i52 = c.multiplier - 1;
  // The CPU keeps what /TA asked for; the data have until the strobe ended.
  const Limits* asked = &limits({c.multiplier, c.wait_states, c.asked});
  if (c.stretched != c.asked) {
    mixed_ = *asked;
    const Limits& data = limits({c.multiplier, c.wait_states, c.stretched});
    for (const Rule rule : {k104, k105}) mixed_.row[rule] = data.row[rule];
    asked = &mixed_;
  }
  const Limits& rows = *asked;
  enter(k100, rows, c.end - c.start);
  c.write ? write(c, rows) : read(c, rows);
  if (c.wait_states > 0) acknowledge(c, rows);
  ledger_.holds(kOneStrobe, region_, !c.both_strobes, place_);
  ledger_.holds(kAddressStands, region_, !c.address_moved, place_);
  ledger_.holds(kEnoughWaitStates, region_, c.multiplier < k150MHz || c.wait_states > 1, place_);
  ledger_.holds(kDrivesInside, region_, !c.drives_outside, place_);
  if (c.turnaround) ledger_.enter(c.cpu_followed ? kBoardLetsGo : kCpuLetsGo, region_, 0, *c.turnaround, place_);
  (c.write ? last_write_ : last_read_) = c;
}

void PortATiming::read(const PinCycle& c, const Limits& rows) {
  enter(k115, rows, c.strobe_low - c.start);
  enter(k116, rows, c.strobe_high - c.strobe_low);
  enter(k117, rows, c.end - c.strobe_high);
  enter(k104, rows, c.data_valid - c.start);
  enter(k105, rows, c.data_valid - c.strobe_low);
  enter(k106, rows, c.data_held - c.strobe_high);
  const TimeFs margin =
      std::min(*rows.row[k104] - (c.data_valid - c.start), c.data_lost ? c.data_held - c.strobe_high : kForever);
  if (margin < worst_margin_) {
    worst_margin_ = margin;
    worst_read_ = c;
  }
  need(kS1, c.strobe_high - c.strobe_low);
  if (last_read_) between(k113, *last_read_, c, c.strobe_low - last_read_->strobe_high);
}

void PortATiming::write(const PinCycle& c, const Limits& rows) {
  enter(k101, rows, c.strobe_low - c.start);
  enter(k102, rows, c.strobe_high - c.strobe_low);
  enter(k103, rows, c.end - c.strobe_high);
  enter(k107, rows, c.strobe_high - c.start);
  enter(k108, rows, c.strobe_high - c.data_valid);
  enter(k109, rows, c.data_held - c.strobe_high);
  enter(k110, rows, c.data_on - c.strobe_low);
  enter(k111, rows, c.data_off - c.strobe_high);
  need(kW1, c.data_valid - c.strobe_low);
  need(kW2, std::min(c.end, c.data_held) - c.strobe_low);
  need(kS1, c.strobe_high - c.strobe_low);
  if (last_read_) between(k112, *last_read_, c, c.data_on - last_read_->strobe_high);
  if (last_write_) between(k114, *last_write_, c, c.strobe_low - last_write_->strobe_high);
}

// A move inside the window is no fault by itself: the device may be ready at any phase of the CPU clock. It is one when
// wrong data come of it: the strobe ended although the device had taken its answer back, or the data were not there
// yet.
void PortATiming::acknowledge(const PinCycle& c, const Limits& rows) {
  ta_moves_.seen += c.ta_seen;
  ta_moves_.missed += c.ta_missed;
  const TimeFs set_up = c.strobe_high - c.ta_moved;
  const bool inside = set_up < *rows.row[k118];
  if (!inside || (c.corrupted && !c.ta_high)) enter(k118, rows, set_up);
  enter(k119, rows, inside && c.ta_high ? -set_up : c.ta_held - c.strobe_high);
}

void PortATiming::between(Rule rule, const PinCycle& first, const PinCycle& c, TimeFs measured) {
  enter(rule, limits({std::max(first.multiplier, c.multiplier), std::min(first.wait_states, c.wait_states), 0}),
        measured);
}

void PortATiming::forget() {
  ledger_.forget();
  last_read_.reset();
  last_write_.reset();
  ta_moves_ = {};
  worst_read_.reset();
  worst_margin_ = kForever;
}

}  // namespace brick
