// Named signals: declaration, present values, and the hand-over of every change to the waveform.
#include "systemc/core/signals.h"

#include <stdexcept>

#include "systemc/core/trace.h"

namespace brick {

namespace {
constexpr std::string_view kTopScope = "brick.";
}

Signals::Id Signals::declare(const std::string& name, unsigned width, Radix radix) {
  if (width < 1 || width > 64) throw std::logic_error("signal " + name + ": width must be 1 to 64");
  const Id id = static_cast<Id>(info_.size());
  if (!by_name_.emplace(name, id).second) throw std::logic_error("signal " + name + " is declared twice");
  info_.push_back({name, width, radix});
  same_as_.push_back(id);
  value_.push_back(0);
  source_.emplace_back();
  traced_.push_back(false);
  sampled_.push_back(false);
  return id;
}

Signals::Id Signals::add(const std::string& name, unsigned width, Radix radix, std::uint64_t initial) {
  const Id id = declare(name, width, radix);
  value_[id] = initial;
  if (radix == Radix::kText) text_[id] = "";
  trace_name(id);
  return id;
}

Signals::Id Signals::add_alias(const std::string& name, Id of) {
  const Id id = declare(name, info_[of].width, info_[of].radix);
  same_as_[id] = of;
  trace_name(id);
  return id;
}

void Signals::trace_name(Id id) {
  if (trace_ == nullptr || !groups_.select(info_[id].name)) return;
  traced_[same_as_[id]] = true;
  trace_->declare(id, info_[id], same_as_[id]);
}

void Signals::change(Id id, TimeFs time, std::uint64_t value) {
  value_[id] = value;
  if (traced(id)) trace_->record(id, time, value);
}

void Signals::set_text(Id id, TimeFs time, const std::string& text) {
  std::string& present = text_.at(id);
  if (present == text) return;
  present = text;
  if (traced(id)) trace_->record_text(id, time, text);
}

std::optional<Signals::Id> Signals::find(std::string_view name) const {
  if (name.substr(0, kTopScope.size()) == kTopScope) name.remove_prefix(kTopScope.size());
  const auto it = by_name_.find(name);
  if (it == by_name_.end()) return std::nullopt;
  return it->second;
}

void Signals::attach(TraceWriter* trace, const TraceGroups& groups) {
  trace_ = trace;
  groups_ = groups;
  ++attachments_;
  traced_.assign(info_.size(), false);
  for (Id id = 0; id < info_.size(); ++id) trace_name(id);
  for (Id id = 0; id < info_.size(); ++id) {
    if (!traced(id)) continue;
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
