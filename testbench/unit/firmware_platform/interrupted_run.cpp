// BRICK_INTERRUPTS=SEED or SEED,GAP: all tests of an executable with interrupts anywhere in the firmware
// (fake_interrupts.h), one every GAP accesses to memory (default 150), each test by a seed of its own.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "testbench/unit/firmware_platform/fake_interrupts.h"

namespace {

class InterruptedRun : public ::testing::EmptyTestEventListener {
 public:
  InterruptedRun(unsigned seed, unsigned gap) : seed_(seed), gap_(gap) {}

 private:
  void OnTestStart(const ::testing::TestInfo&) override { fake_interrupts_begin(seed_, gap_); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    const fake_interrupt_counts counts = fake_interrupts_counts();
    fake_interrupts_end();
    for (unsigned task = FAKE_REAL_TIME; task <= FAKE_HOST; ++task) taken_[task] += counts.taken[task];
    torn_ += counts.torn;
    if (test.result()->Failed()) std::printf("seed %u, an interrupt every %u accesses\n", seed_, gap_);
  }
  void OnTestProgramEnd(const ::testing::UnitTest&) override {
    std::printf("interrupts: %lu real-time, %lu servo, %lu phase, %lu host port; %lu between halves of an access\n",
                taken_[FAKE_REAL_TIME], taken_[FAKE_SERVO], taken_[FAKE_PHASE], taken_[FAKE_HOST], torn_);
  }

  unsigned seed_, gap_;
  unsigned long taken_[FAKE_HOST + 1] = {}, torn_ = 0;
};

const bool installed = [] {
  const char* text = std::getenv("BRICK_INTERRUPTS");
  if (text == nullptr) return false;
  char* rest = nullptr;
  const auto seed = static_cast<unsigned>(std::strtoul(text, &rest, 10));
  const auto gap = static_cast<unsigned>(*rest == ',' ? std::strtoul(rest + 1, nullptr, 10) : 150);
  ::testing::UnitTest::GetInstance()->listeners().Append(new InterruptedRun(seed, gap));  // owned by GoogleTest
  return true;
}();

}  // namespace
