// Time series of a run (`--record FILE.csv`, docs/record.md): a line of names, then a row for each servo interrupt, as
// its task has left the machine. The time is that of the interrupt, the fall of SERVO, so rows stand at even distances.
// It reads by the back door: the controller does the same with it and without.
#pragma once

#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "app/record_column.h"
#include "systemc/machine/machine.h"

namespace brick {

class Recorder {
 public:
  // What `--record-of` says, "" = `defaults`. Takes on_outputs and on_task of the machine, whose former owners are
  // called on; ends before they do. Throws UsageError.
  Recorder(Machine& machine, const std::string& file, const std::string& of, const std::string& defaults);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void close();  // writes what is left; throws UsageError if the file could not be written
  std::function<void(const std::string&)> on_failure;  // then, and no row comes after it; once

  static void check_name(const std::string& file);  // throws UsageError unless it ends in .csv

 private:
  void task_changed();
  void row();
  void fail(int error);

  Machine& machine_;
  std::string file_;
  std::ofstream out_;
  std::vector<RecordColumn> columns_;
  decltype(Machine::on_outputs) on_outputs_;
  decltype(Machine::on_task) on_task_;
  bool in_servo_ = false;
  TimeFs fell_ = 0;  // SERVO
  std::string failure_;
};

}  // namespace brick
