// Ordering and window of waveform records, see trace_queue.h.
#include "systemc/core/trace_queue.h"

#include <algorithm>
#include <stdexcept>

namespace brick {

namespace {
// Records are sorted and written in lots: sorting for every bus access would cost more than the simulation.
constexpr std::size_t kLot = 16384;
}  // namespace

void TraceQueue::declare(Signals::Id id, const Signals::Info& info) {
  if (header_) throw std::logic_error("signal " + info.name + " is declared after the waveform began");
  if (id >= declared_.size()) declared_.resize(id + 1);
  declared_[id].info = info;
}

void TraceQueue::record(Signals::Id id, TimeFs time, std::uint64_t value) {
  if (time > to_) return;
  pending_.push_back({time, value, id});
}

void TraceQueue::record_text(Signals::Id id, TimeFs time, const std::string& text) {
  if (time > to_) return;
  pending_.push_back({time, texts_.size(), id});
  texts_.push_back(text);
}

void TraceQueue::flush_until(TimeFs time) {
  complete_ = std::max(complete_, time);
  if (pending_.size() >= kLot) write_until(complete_);
}

void TraceQueue::write_until(TimeFs time) {
  if (!header_) {
    header_ = true;
    TraceScope top;
    for (Signals::Id id = 0; id < declared_.size(); ++id) {
      TraceScope* scope = &top;
      const std::string& name = declared_[id].info.name;
      std::size_t start = 0;
      for (std::size_t dot; (dot = name.find('.', start)) != std::string::npos; start = dot + 1)
        scope = &scope->scopes[name.substr(start, dot - start)];
      scope->signals[name.substr(start)] = id;
    }
    write_header(top);
  }
  std::stable_sort(pending_.begin(), pending_.end(), [](const Record& a, const Record& b) { return a.time < b.time; });
  const auto end = std::find_if(pending_.begin(), pending_.end(), [&](const Record& r) { return r.time >= time; });
  for (auto r = pending_.begin(); r != end; ++r) write_one(*r);
  pending_.erase(pending_.begin(), end);
  std::vector<std::string> kept;
  for (Record& r : pending_) {
    if (declared_[r.id].info.radix != Radix::kText) continue;
    kept.push_back(std::move(texts_[r.value]));
    r.value = kept.size() - 1;
  }
  texts_ = std::move(kept);
}

void TraceQueue::write_one(const Record& r) {
  Declared& d = declared_[r.id];
  const bool text = d.info.radix == Radix::kText;
  if (r.time > from_) open_window();
  if (d.known && (text ? d.text == texts_[r.value] : d.value == r.value)) return;
  d.known = true;
  if (text)
    d.text = texts_[r.value];
  else
    d.value = r.value;
  if (!window_) return;
  advance(r.time);
  write_declared(r.id);
}

void TraceQueue::open_window() {
  if (window_) return;
  window_ = true;
  last_ps_ = from_ / kFsPerPs;
  write_time(last_ps_, true);
  for (Signals::Id id = 0; id < declared_.size(); ++id)
    if (declared_[id].known) write_declared(id);
}

void TraceQueue::write_declared(Signals::Id id) {
  if (declared_[id].info.radix == Radix::kText)
    write_text(id, declared_[id].text);
  else
    write_value(id, declared_[id].value);
}

void TraceQueue::advance(TimeFs time) {
  const std::int64_t ps = time / kFsPerPs;
  if (ps <= last_ps_) return;  // same time unit
  last_ps_ = ps;
  write_time(ps, false);
}

void TraceQueue::close() {
  if (closed_) return;
  closed_ = true;
  write_until(INT64_MAX);
  const TimeFs end = std::min(complete_, to_);
  if (end >= from_) {
    open_window();
    advance(end);  // so that the picture reaches to the end of the run
  }
  finish();
}

}  // namespace brick
