#include "app/timing_waivers.h"

#include <algorithm>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"
#include "systemc/machine/toml_table.h"

namespace brick {

namespace {

constexpr const char* kAddressForm =
    "an address such as \"X:$078000\", \"I/O 0x213\" or \"memory 0x0D0000\", or a range of two with .. between";

std::string read_file(const std::string& path) {
  return read_input_file(path, "a TOML file of waivers", fmt::format("--waive \"{}\"", path));
}

}  // namespace

TimingWaivers::TimingWaivers(const std::string& path) : path_(path) {
  const toml::table root = parse_toml(read_file(path), path);
  const TomlTable file(path, root, {"waive"});
  if (!file.has("waive")) return;
  for (const toml::node& item : file.array("waive")) {
    const TomlTable entry = file.table("waive", item, {"rule", "address", "reason"});
    Waiver w;
    w.line = TomlTable::line(item);
    w.rule_line = TomlTable::line(entry.need("rule"));
    w.address_line = TomlTable::line(entry.need("address"));
    w.rule = entry.text("rule");
    w.address = entry.text("address");
    w.reason = entry.text("reason");
    if (w.reason.find_first_not_of(" \t\n") == std::string::npos)
      entry.fail(entry.need("reason"), "reason", "why the violation is harmless");
    static const std::regex kAddress(R"((X:|Y:|I/O |memory )(?:\$|0x)([0-9A-Fa-f]{1,6})(?:\.\.(X:|Y:|I/O |memory )?)"
                                     R"((?:\$|0x)([0-9A-Fa-f]{1,6}))?)");
    std::smatch m;
    if (!std::regex_match(w.address, m, kAddress)) entry.fail(entry.need("address"), "address", kAddressForm);
    w.space = m[1].str()[0] == 'm' ? 'M' : m[1].str()[0];
    w.first = static_cast<std::uint32_t>(std::stoul(m[2], nullptr, 16));
    if (m[3].matched && m[3] != m[1]) entry.fail(entry.need("address"), "address", "both ends in one space");
    w.last = m[4].matched ? static_cast<std::uint32_t>(std::stoul(m[4], nullptr, 16)) : w.first;
    if (w.last < w.first) entry.fail(entry.need("address"), "address", "the lower address first");
    waivers_.push_back(std::move(w));
  }
}

void TimingWaivers::check(const std::vector<TimingLedger*>& ledgers) const {
  std::vector<std::string> known;
  for (const TimingLedger* ledger : ledgers)
    for (const TimingRule& rule : ledger->rules()) known.push_back(rule.id);
  for (const Waiver& w : waivers_) {
    if (std::find(known.begin(), known.end(), w.rule) == known.end())
      throw UsageError(fmt::format("{}:{}: rule: no rule \"{}\"; expected one of {}", path_, w.rule_line, w.rule,
                                   fmt::join(known, ", ")));
    std::string buses;
    const bool there = std::any_of(ledgers.begin(), ledgers.end(), [&](const TimingLedger* ledger) {
      const auto& rules = ledger->rules();
      if (std::none_of(rules.begin(), rules.end(), [&](const TimingRule& r) { return r.id == w.rule; })) return false;
      buses += buses.empty() ? ledger->bus() : " or " + ledger->bus();
      return ledger->spaces().find(w.space) != std::string::npos;
    });
    if (!there)
      throw UsageError(fmt::format("{}:{}: address: \"{}\" is on another bus than rule {}; expected an address of {}",
                                   path_, w.address_line, w.address, w.rule, buses));
  }
}

std::string TimingWaivers::reason(const TimingLedger& ledger, const TimingViolation& v) {
  for (Waiver& w : waivers_) {
    if (w.rule != ledger.rules()[v.rule].id || w.space != v.where.space) continue;
    if (v.where.address < w.first || v.where.address > w.last) continue;
    w.used = true;
    return w.reason;
  }
  return "";
}

std::vector<std::string> TimingWaivers::unused() const {
  std::vector<std::string> lines;
  for (const Waiver& w : waivers_)
    if (!w.used)
      lines.push_back(fmt::format("{}:{}: waiver of rule {} at {} was not needed", path_, w.line, w.rule, w.address));
  return lines;
}

}  // namespace brick
