// Columns of a record (`--record-of`, docs/record.md): signals by name, numbers of a motor, words of the main memory as
// M definitions. Text to a list of columns, each a name and what reads its value; nothing of it costs the controller
// time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"

namespace brick {

// What a column may need of the row before.
struct RecordRow {
  double ms = 0;  // simulated time
};

struct RecordColumn {
  std::string name;
  std::function<double(const RecordRow&)> value;  // asked once a row, in order
};

// The columns that `text` asks for: items divided by blanks or semicolons, each
//   a signal of docs/signals.md by name or glob, text signals apart;
//   motorN.commanded, actual, error (counts), velocity, acceleration (of commanded; counts/ms, counts/ms^2), output
//   (bits of 16); csN.lines, words (of the rotary buffer that are not calculated); N may be a glob;
//   feed:N/counts a unit,... (the vector of these motors' velocities, a ms), also `name=feed:...`;
//   an M definition X:, Y: (address, first bit, width, S or U), D: or L: of the main memory, also `name=definition`,
//   with `/number` behind it divided by that.
// Throws UsageError that says which item is wrong, and what was expected.
std::vector<RecordColumn> record_columns(Machine& machine, const std::string& text);

}  // namespace brick
