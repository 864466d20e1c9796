// What both waveform formats share: holding records back until they are in order, the time window, dropping of values
// that do not change, and the tree of scopes. A format only writes: header, time, value.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "systemc/core/trace.h"

namespace brick {

constexpr TimeFs kFsPerPs = 1000;  // the time unit of both formats

// Signals as a tree: the parts of a name between its dots are scopes.
struct TraceScope {
  std::map<std::string, TraceScope> scopes;
  std::map<std::string, Signals::Id> signals;  // last part of the name
};

class TraceQueue : public TraceWriter {
 public:
  TraceQueue(TimeFs from, TimeFs to) : from_(from), to_(to) {}

  void declare(Signals::Id id, const Signals::Info& info) override;
  void record(Signals::Id id, TimeFs time, std::uint64_t value) override;
  void record_text(Signals::Id id, TimeFs time, const std::string& text) override;
  void flush_until(TimeFs time) override;
  void close() override;

 protected:
  struct Declared {
    Signals::Info info;
    bool known = false;  // a record has given it a value
    std::uint64_t value = 0;
    std::string text;
  };
  const std::vector<Declared>& declared() const { return declared_; }

  virtual void write_header(const TraceScope& top) = 0;
  virtual void write_time(std::int64_t ps, bool first) = 0;
  virtual void write_value(Signals::Id id, std::uint64_t value) = 0;
  virtual void write_text(Signals::Id id, const std::string& text) = 0;
  virtual void finish() = 0;

 private:
  struct Record {
    TimeFs time;
    std::uint64_t value;  // of a text: index into texts_
    Signals::Id id;
  };
  void write_until(TimeFs time);
  void write_one(const Record& r);
  void open_window();
  void write_declared(Signals::Id id);
  void advance(TimeFs time);

  const TimeFs from_, to_;
  std::vector<Declared> declared_;
  std::vector<Record> pending_;
  std::vector<std::string> texts_;
  TimeFs complete_ = 0;       // no record before this time will come any more
  std::int64_t last_ps_ = 0;  // time written last
  bool header_ = false;
  bool window_ = false;
  bool closed_ = false;
};

}  // namespace brick
