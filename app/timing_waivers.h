// Waivers of timing violations, a TOML file that people write (`--waive`, docs/timing.md): each names a rule, an
// address or a range, and a reason. Mistakes are UsageErrors of one line. One that waived nothing is told at the end.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/checkers/timing_book.h"

namespace brick {

class TimingWaivers {
 public:
  TimingWaivers() = default;                        // none
  explicit TimingWaivers(const std::string& path);  // throws UsageError

  // Every rule must be one of the ledgers, its address one of that bus. Throws UsageError.
  void check(const std::vector<TimingLedger*>& ledgers) const;

  // The reason, if this violation is waived; "" if not. What is asked for counts as used.
  std::string reason(const TimingLedger& ledger, const TimingViolation& violation);
  std::vector<std::string> unused() const;  // one line each

 private:
  struct Waiver {
    std::string rule, address, reason;
    char space = ' ';
    std::uint32_t first = 0, last = 0;
    int line = 0, rule_line = 0, address_line = 0;
    bool used = false;
  };
  std::string path_;
  std::vector<Waiver> waivers_;
};

}  // namespace brick
