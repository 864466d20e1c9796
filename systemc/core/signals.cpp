// Named signals: declaration, present values, and the hand-over of every change to the waveform.
#include "systemc/core/signals.h"

#include <stdexcept>

#include "systemc/core/trace.h"

namespace brick {

namespace {
constexpr std::string_view kTopScope = "brick.";
}

Signals::Id Signals::add(const std::string& name, unsigned width, Radix radix, std::uint64_t initial) {
  if (width < 1 || width > 64) throw std::logic_error("signal " + name + ": width must be 1 to 64");
  const Id id = static_cast<Id>(info_.size());
  if (!by_name_.emplace(name, id).second) throw std::logic_error("signal " + name + " is declared twice");
  info_.push_back({name, width, radix});
  value_.push_back(initial);
  source_.emplace_back();
  if (radix == Radix::kText) text_[id] = "";
  if (trace_ != nullptr) trace_->declare(id, info_[id]);
  return id;
}

void Signals::set(Id id, TimeFs time, std::uint64_t value) {
  if (value_[id] == value) return;
  value_[id] = value;
  if (trace_ != nullptr) trace_->record(id, time, value);
}

void Signals::set_text(Id id, TimeFs time, const std::string& text) {
  std::string& present = text_.at(id);
  if (present == text) return;
  present = text;
  if (trace_ != nullptr) trace_->record_text(id, time, text);
}

std::optional<Signals::Id> Signals::find(std::string_view name) const {
  if (name.substr(0, kTopScope.size()) == kTopScope) name.remove_prefix(kTopScope.size());
  const auto it = by_name_.find(name);
  if (it == by_name_.end()) return std::nullopt;
  return it->second;
}

void Signals::attach(TraceWriter* trace) {
  trace_ = trace;
  if (trace_ == nullptr) return;
  for (Id id = 0; id < info_.size(); ++id) trace_->declare(id, info_[id]);
  for (Id id = 0; id < info_.size(); ++id) {
    if (info_[id].radix == Radix::kText)
      trace_->record_text(id, 0, text_[id]);
    else
      trace_->record(id, 0, value_[id]);
  }
}

void Signals::flush_until(TimeFs time) {
  if (trace_ != nullptr) trace_->flush_until(time);
}

}  // namespace brick
