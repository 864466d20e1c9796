// Ordering and window of waveform records, see trace_queue.h.
#include "systemc/core/trace_queue.h"

#include <algorithm>
#include <stdexcept>

namespace brick {

namespace {
// Records are merged and written in lots: doing it for every bus access would cost more than the simulation.
constexpr std::size_t kLot = 16384;
}  // namespace

void TraceQueue::declare(Signals::Id id, const Signals::Info& info, Signals::Id of) {
  if (header_) throw std::logic_error("signal " + info.name + " is declared after the waveform began");
  if (std::max(id, of) >= declared_.size()) declared_.resize(std::max(id, of) + 1);
  if (!declared_[of].declared) declared_[of].info = info;  // a signal may be known by its aliases alone
  declared_[id].info = info;
  declared_[id].of = of;
  declared_[id].declared = true;
}

void TraceQueue::record(Signals::Id id, TimeFs time, std::uint64_t value) {
  if (time > to_ || !failure_.empty()) return;
  add(time, value, id);
}

void TraceQueue::record_text(Signals::Id id, TimeFs time, const std::string& text) {
  if (time > to_ || !failure_.empty()) return;
  const auto [entry, added] = text_index_.try_emplace(text, texts_.size());
  if (added) texts_.push_back(&entry->first);
  add(time, entry->second, id);
}

// A source goes forward in time, so each finds a run that it can lengthen, and there are few to be merged. Of two
// records of one time the later one never goes to an earlier run: those had ended beyond that time already.
void TraceQueue::add(TimeFs time, std::uint64_t value, Signals::Id id) {
  const auto run =
      std::find_if(runs_.begin(), runs_.end(), [time](const auto& r) { return r.empty() || r.back().time <= time; });
  (run != runs_.end() ? *run : runs_.emplace_back()).push_back({time, value, id});
  ++pending_;
}

void TraceQueue::flush_until(TimeFs time) {
  complete_ = std::max(complete_, time);
  if (pending_ < kLot) return;
  try {
    write_until(complete_);
  } catch (const std::exception& e) {
    if (!on_failure) throw;
    give_up(e.what());
  }
}

void TraceQueue::give_up(const std::string& why) {
  failure_ = why;
  runs_.clear();
  pending_ = 0;
  on_failure(failure_);
}

void TraceQueue::write_until(TimeFs time) {
  if (!header_) {
    header_ = true;
    TraceScope top;
    for (Signals::Id id = 0; id < declared_.size(); ++id) {
      if (!declared_[id].declared) continue;
      TraceScope* scope = &top;
      const std::string& name = declared_[id].info.name;
      std::size_t start = 0;
      for (std::size_t dot; (dot = name.find('.', start)) != std::string::npos; start = dot + 1)
        scope = &scope->scopes[name.substr(start, dot - start)];
      scope->signals[name.substr(start)] = id;
    }
    write_header(top);
  }
  merge_until(time);
}

void TraceQueue::merge_until(TimeFs time) {
  std::vector<std::size_t> next(runs_.size());
  for (;;) {
    const Record* first = nullptr;
    std::size_t from = 0;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (next[i] == runs_[i].size()) continue;
      const Record& r = runs_[i][next[i]];
      if (r.time < time && (first == nullptr || r.time < first->time)) first = &r, from = i;
    }
    if (first == nullptr) break;
    write_one(*first);
    ++next[from];
  }
  pending_ = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    runs_[i].erase(runs_[i].begin(), runs_[i].begin() + static_cast<std::ptrdiff_t>(next[i]));
    pending_ += runs_[i].size();
  }
}

void TraceQueue::write_one(const Record& r) {
  Declared& d = declared_[r.id];
  if (r.time > from_) open_window();
  if (d.known && d.value == r.value) return;
  d.known = true;
  d.value = r.value;
  if (!window_) return;
  advance(r.time);
  write_declared(r.id);
}

void TraceQueue::open_window() {
  if (window_) return;
  window_ = true;
  last_ps_ = to_ps(from_);
  write_time(last_ps_, true);
  for (Signals::Id id = 0; id < declared_.size(); ++id)
    if (declared_[id].known) write_declared(id);
}

void TraceQueue::write_declared(Signals::Id id) {
  if (declared_[id].info.radix == Radix::kText)
    write_text(id, *texts_[declared_[id].value]);
  else
    write_value(id, declared_[id].value);
}

void TraceQueue::advance(TimeFs time) {
  const std::int64_t ps = to_ps(time);
  if (ps <= last_ps_) return;  // same time unit
  last_ps_ = ps;
  write_time(ps, false);
}

void TraceQueue::close() {
  if (closed_) return;
  closed_ = true;
  if (!failure_.empty()) throw std::runtime_error(failure_);
  write_until(kForever);
  const TimeFs end = std::min(complete_, to_);
  if (end >= from_) {
    open_window();
    advance(end);  // so that the picture reaches to the end of the run
  }
  finish();
}

}  // namespace brick
