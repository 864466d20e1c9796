// Named signals of the running machine: the one place that knows every value a user can see, for `@signal`, `@until`
// and the waveform. Sources set values with their own time stamp and may run ahead of each other; the trace sorts.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

class TraceWriter;  // systemc/core/trace.h

enum class Radix { kBinary, kHex, kDecimal, kSigned, kText };

class Signals {
 public:
  using Id = std::uint32_t;

  // Declares a signal. `name` is dotted, without the top scope `brick` (docs/signals.md), e.g. "host.isa.sa".
  Id add(const std::string& name, unsigned width, Radix radix, std::uint64_t initial = 0);

  void set(Id id, TimeFs time, std::uint64_t value);
  void set_text(Id id, TimeFs time, const std::string& text);

  // The value is not followed while there is no waveform: whoever wants it asks `source`.
  void ask(Id id, std::function<std::uint64_t()> source) { source_[id] = std::move(source); }

  struct Info {
    std::string name;
    unsigned width;
    Radix radix;
  };
  const Info& info(Id id) const { return info_[id]; }
  std::size_t size() const { return info_.size(); }
  std::uint64_t value(Id id) const { return trace_ == nullptr && source_[id] ? source_[id]() : value_[id]; }
  const std::string& text(Id id) const { return text_.at(id); }
  std::optional<Id> find(std::string_view name) const;  // accepts a leading "brick."

  // Attaches the waveform file; not owned. Values set from now on are written, the present ones first.
  void attach(TraceWriter* trace);
  bool traced() const { return trace_ != nullptr; }
  void flush_until(TimeFs time);  // no value before `time` will be set any more

 private:
  std::vector<Info> info_;
  std::vector<std::uint64_t> value_;
  std::vector<std::function<std::uint64_t()>> source_;
  std::map<Id, std::string> text_;
  std::map<std::string, Id, std::less<>> by_name_;
  TraceWriter* trace_ = nullptr;
};

}  // namespace brick
