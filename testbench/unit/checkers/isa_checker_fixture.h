// Cycles of the host bus made up point by point, for the checker of its rules: host and board keep every rule unless a
// test moves a point.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "testbench/checkers/isa_checker.h"
#include "testbench/unit/covers.h"

namespace brick {

constexpr TimeFs kNs = kFsPerNs;

constexpr TimeFs kUsual = -1;

// The points of one cycle, and of what the board does in it; kNever does not happen. Whatever is not set keeps the
// rules.
struct Points {
  TimeFs la = -200 * kNs, sa = -200 * kNs, data = -100 * kNs;  // from the fall of the command
  TimeFs width = 600 * kNs;
  TimeFs release = 40 * kNs, data_release = 40 * kNs;  // from its end
  TimeFs next = 300 * kNs;
  TimeFs valid = kUsual, off = 8 * kNs;               // of read data, usually in reads alone; off from the end
  unsigned lanes = 3;                                 // that the board drives
  TimeFs ready_low = kNever, ready_high = 200 * kNs;  // from the fall
  TimeFs memcs16 = 30 * kNs;                          // from LA
};

class IsaCheckerTest : public ::testing::Test {
 protected:
  using Rule = IsaChecker::Rule;

  IsaCheckerTest() {
    in_.rst_n = true;
    out_.set(pin::kIsaIochrdy, 1);
    out_.set(pin::kIsaMemcs16N, 1);
    out_.set(pin::kTxde, 1);
    show();
  }

  void show() { checker_.pins(now_, in_, out_); }
  template <class Edit>
  void at(TimeFs time, Edit edit) {
    plan_.push_back({time, edit});
  }
  void play() {
    std::stable_sort(plan_.begin(), plan_.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    for (const auto& step : plan_) {
      now_ = step.time;
      step.edit();
      show();
    }
    plan_.clear();
  }

  // One cycle whose command falls `points.next` after the end of the last one.
  void cycle(bool BoardInputs::*command, std::uint32_t address, const Points& p) {
    const TimeFs low = end_ + p.next, high = low + p.width;
    const bool memory = command == &BoardInputs::isa_memr_n || command == &BoardInputs::isa_memw_n;
    if (memory) {
      at(low + p.la, [=] { in_.isa_la = static_cast<std::uint8_t>(address >> 17); });
      at(low + p.la + p.memcs16, [=] { out_.set(pin::kIsaMemcs16N, address >> 17 != 6); });
    }
    at(low + p.sa, [=] { in_.isa_sa = address & 0xFFFFF, in_.isa_sbhe_n = !memory; });
    at(low + p.data, [=] { in_.isa_sd = ++data_; });
    at(low, [=] { in_.*command = false; });
    const bool read = command == &BoardInputs::isa_ior_n || command == &BoardInputs::isa_memr_n;
    const bool shows = p.valid == kUsual ? read && p.width > 50 * kNs : p.valid != kNever;
    if (shows) {
      at(low + (p.valid == kUsual ? 50 * kNs : p.valid), [=] { out_.set(pin::kIsaSdOe, p.lanes); });
      at(high + p.off, [=] { out_.set(pin::kIsaSdOe, 0); });
    }
    if (p.ready_low != kNever) {
      at(low + p.ready_low, [=] { out_.set(pin::kIsaIochrdy, 0); });
      at(low + p.ready_high, [=] { out_.set(pin::kIsaIochrdy, 1); });
    }
    at(high, [=] { in_.*command = true; });
    at(high + p.release, [=] { in_.isa_sa = 0xFFFFF, in_.isa_sbhe_n = true, in_.isa_la = 0x7F; });
    at(high + p.data_release, [=] { in_.isa_sd = 0xFFFF; });
    if (memory) at(high + p.release, [=] { out_.set(pin::kIsaMemcs16N, 1); });
    end_ = high;
    play();
  }
  void io(const Points& p, std::uint32_t address = 0x212) { cycle(&BoardInputs::isa_ior_n, address, p); }
  void iow(const Points& p, std::uint32_t address = 0x213) { cycle(&BoardInputs::isa_iow_n, address, p); }
  void memr(const Points& p, std::uint32_t address = 0xD0000) { cycle(&BoardInputs::isa_memr_n, address, p); }
  void memw(const Points& p, std::uint32_t address = 0xD0000) { cycle(&BoardInputs::isa_memw_n, address, p); }

  std::vector<std::string> broken() const {
    std::vector<std::string> ids;
    for (const TimingViolation& v : checker_.ledger().violations()) ids.push_back(checker_.ledger().rules()[v.rule].id);
    return ids;
  }
  // `limit` keeps the rule with margin 0 and nothing else is broken; `beyond` breaks it alone.
  template <class Run>
  void expect_limit(Rule rule, Run run, const Points& limit, const Points& beyond,
                    IsaChecker::Region region = IsaChecker::kIo) {
    const std::string id = checker_.ledger().rules()[rule].id;
    SCOPED_TRACE(id);
    checker_.ledger().forget();
    run(limit);
    EXPECT_THAT(broken(), ::testing::IsEmpty());
    EXPECT_EQ(checker_.ledger().row(rule, region).margin, 0);
    run(beyond);
    ASSERT_EQ(broken(), std::vector<std::string>{id});
    EXPECT_EQ(checker_.ledger().row(rule, region).margin, -1);
  }
  template <class Run>
  void expect_limit(Rule rule, Run run, TimeFs Points::*point, TimeFs limit, int worse,
                    IsaChecker::Region region = IsaChecker::kIo, Points usual = {}) {
    Points beyond = usual;
    usual.*point = limit;
    beyond.*point = limit + worse;
    expect_limit(rule, run, usual, beyond, region);
  }

  struct Step {
    TimeFs time;
    std::function<void()> edit;
  };
  IsaChecker checker_;
  BoardInputs in_;
  BoardOutputs out_;
  std::vector<Step> plan_;
  TimeFs now_ = 0, end_ = 1000 * kNs;
  std::uint16_t data_ = 0;
};

}  // namespace brick
