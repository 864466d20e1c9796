// Named signals of the running machine: the one place that knows every value a user can see, for `@signal`, `@until`
// and the waveform. Sources set values with their own time stamp and may run ahead of each other; the trace sorts.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "systemc/core/ticks.h"
#include "systemc/core/trace_groups.h"

namespace brick {

class TraceWriter;  // systemc/core/trace.h

enum class Radix { kBinary, kHex, kDecimal, kSigned, kText, kReal };

// A kReal signal is 64 bits wide, those of the number.
inline std::uint64_t bits_of(double number) {
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}
inline double real_of(std::uint64_t bits) {
  double number;
  std::memcpy(&number, &bits, sizeof number);
  return number;
}

class Signals {
 public:
  using Id = std::uint32_t;

  // Declares a signal. `name` is dotted, without the top scope `brick` (docs/signals.md), e.g. "host.isa.sa".
  Id add(const std::string& name, unsigned width, Radix radix, std::uint64_t initial = 0);

  // One more name of the signal `of`, which is set under its first name.
  Id add_alias(const std::string& name, Id of);

  void set(Id id, TimeFs time, std::uint64_t value) {
    if (value_[id] != value) change(id, time, value);
  }
  void set_text(Id id, TimeFs time, const std::string& text);

  // The value is not followed while the waveform does not want it: whoever wants it asks `source`. One that the
  // waveform has samples of is asked for even then.
  void ask(Id id, std::function<std::uint64_t()> source, bool sampled = false) {
    source_[id] = std::move(source);
    sampled_[id] = sampled;
  }

  struct Info {
    std::string name;
    unsigned width;
    Radix radix;
  };
  const Info& info(Id id) const { return info_[id]; }
  std::size_t size() const { return info_.size(); }
  std::uint64_t value(Id id) const {
    id = same_as_[id];
    return (!traced_[id] || sampled_[id]) && source_[id] ? source_[id]() : value_[id];
  }
  const std::string& text(Id id) const { return text_.at(id); }
  std::optional<Id> find(std::string_view name) const;  // accepts a leading "brick."

  // Attaches the waveform file; not owned; nullptr ends it. Values of the signals in `groups` set from now on are
  // written, the present ones first. A signal that is left out costs what it costs without a waveform.
  void attach(TraceWriter* trace, const TraceGroups& groups = TraceGroups::all());
  bool traced() const { return trace_ != nullptr; }
  bool traced(Id id) const { return traced_[id] != 0; }  // it or an alias of it
  unsigned attachments() const { return attachments_; }  // whoever keeps what traced() said looks here for a change
  void flush_until(TimeFs time);                         // no value before `time` will be set any more

 private:
  Id declare(const std::string& name, unsigned width, Radix radix);
  void change(Id id, TimeFs time, std::uint64_t value);
  void trace_name(Id id);

  std::vector<Info> info_;
  std::vector<Id> same_as_;  // of an alias the signal, else itself
  std::vector<std::uint64_t> value_;
  std::vector<std::function<std::uint64_t()>> source_;
  std::map<Id, std::string> text_;
  std::map<std::string, Id, std::less<>> by_name_;
  TraceWriter* trace_ = nullptr;
  TraceGroups groups_;
  std::vector<char> traced_, sampled_;
  unsigned attachments_ = 0;
};

}  // namespace brick
