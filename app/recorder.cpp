#include "app/recorder.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "systemc/core/board_pins.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr unsigned kServoTask = 2;  // of cpu.task, docs/signals.md

// A field of RFC 4180: an M definition has commas.
std::string field(const std::string& name) { return name.find(',') == std::string::npos ? name : '"' + name + '"'; }

// Ten digits, of what is large 15: a word of 48 bits has as many.
std::string number(double value) {
  constexpr double kLarge = 1e6;
  return std::abs(value) < kLarge ? fmt::format("{:.10g}", value) : fmt::format("{:.15g}", value);
}

}  // namespace

void Recorder::check_name(const std::string& file) {
  if (std::filesystem::path(file).extension() != ".csv")
    throw UsageError(fmt::format("--record {}: unknown kind of file; expected FILE.csv", file));
}

Recorder::Recorder(Machine& machine, const std::string& file, const std::string& of, const std::string& defaults)
    : machine_(machine),
      file_(file),
      columns_(record_columns(machine, of.empty() ? defaults : of)),
      on_outputs_(machine.on_outputs),
      on_task_(machine.on_task) {
  out_.open(file);
  if (!out_) throw UsageError(fmt::format("--record {}: cannot be written; expected a writable place", file));
  out_ << "time_ms";
  for (const RecordColumn& column : columns_) out_ << ',' << field(column.name);
  out_ << '\n';
  machine.on_outputs = [this](Tick tick, const BoardOutputs& before, const BoardOutputs& after) {
    if (on_outputs_) on_outputs_(tick, before, after);
    if (before.get(pin::kServo) != 0 && after.get(pin::kServo) == 0) fell_ = tick_to_fs(tick);
  };
  machine.on_task = [this](TimeFs time) {
    if (on_task_) on_task_(time);
    task_changed();
  };
}

Recorder::~Recorder() {
  machine_.on_outputs = on_outputs_;
  machine_.on_task = on_task_;
}

// The servo task has ended when the CPU goes on with one below it; what interrupts it is above.
void Recorder::task_changed() {
  const unsigned task = machine_.task();
  if (in_servo_ && task < kServoTask) row();
  if (task <= kServoTask) in_servo_ = task == kServoTask;
}

void Recorder::row() {
  if (!failure_.empty()) return;
  const RecordRow row{static_cast<double>(fell_) * 1e-12};
  out_ << fmt::format("{:.6f}", row.ms);
  for (const RecordColumn& column : columns_) out_ << ',' << number(column.value(row));
  out_ << '\n';
  if (out_) return;
  fail(errno);
  if (on_failure) on_failure(failure_);
}

void Recorder::fail(int error) {
  failure_ = fmt::format("--record {}: cannot be written beyond about {:.3f} ms: {}; expected room for the rows", file_,
                         static_cast<double>(fell_) * 1e-12, std::strerror(error));
}

void Recorder::close() {
  out_.close();
  if (!out_ && failure_.empty()) fail(errno);
  if (!failure_.empty()) throw UsageError(failure_);
}

}  // namespace brick
