// What both waveform formats share: holding records back until they are in order, the time window, dropping of values
// that do not change, and the tree of scopes. A format only writes: header, time, value.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "systemc/core/trace.h"

namespace brick {

constexpr TimeFs kFsPerPs = 1000;  // the time unit of both formats
// Neither has more than 64 bits for a time, and viewers take them for signed: what comes after 106 days is left out.
constexpr TimeFs kLastTraced = INT64_MAX * kFsPerPs;

// Signals as a tree: the parts of a name between its dots are scopes.
struct TraceScope {
  std::map<std::string, TraceScope> scopes;
  std::map<std::string, Signals::Id> signals;  // last part of the name
};

class TraceQueue : public TraceWriter {
 public:
  TraceQueue(TimeFs from, TimeFs to) : from_(from), to_(std::min(to, kLastTraced)) {}

  void declare(Signals::Id id, const Signals::Info& info, Signals::Id of) override;
  void record(Signals::Id id, TimeFs time, std::uint64_t value) override;
  void record_text(Signals::Id id, TimeFs time, const std::string& text) override;
  void flush_until(TimeFs time) override;
  void close() override;

 protected:
  struct Declared {
    Signals::Info info;
    bool declared = false;    // has a name in this file
    Signals::Id of = 0;       // as declare()
    bool known = false;       // a record has given it a value
    std::uint64_t value = 0;  // of a text: index into texts_
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
    std::uint64_t value;  // as in Declared
    Signals::Id id;
  };
  void add(TimeFs time, std::uint64_t value, Signals::Id id);
  void write_until(TimeFs time);
  void merge_until(TimeFs time);
  void write_one(const Record& r);
  void open_window();
  void write_declared(Signals::Id id);
  void advance(TimeFs time);
  void give_up(const std::string& why);
  static std::int64_t to_ps(TimeFs time) { return static_cast<std::int64_t>(time / kFsPerPs); }

  const TimeFs from_, to_;
  std::vector<Declared> declared_;
  std::vector<std::vector<Record>> runs_;  // what is held back, each in order of time: about one for each source
  std::size_t pending_ = 0;                // records in them
  std::unordered_map<std::string, std::size_t> text_index_;
  std::vector<const std::string*> texts_;  // keys of text_index_, each kept once: there are as many as functions
  TimeFs complete_ = 0;                    // no record before this time will come any more
  std::int64_t last_ps_ = 0;               // time written last
  bool header_ = false;
  bool window_ = false;
  bool closed_ = false;
  std::string failure_;  // why the file takes no more
};

}  // namespace brick
