// What the controller's answers say about I3 and I4. Which lines may change them is read off the line; what they are
// then is asked for with ^B, which is answered whatever buffer is open, and whose answer shows both by its form: a line
// of eight words of twelve hexadecimal digits, which no command says (firmware:5.9/2, firmware:6.2, firmware:6.5). I6
// shows by itself in every error.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "testbench/host/reply_parser.h"

namespace brick {

constexpr char kAskFraming = 0x02;  // ^B

// The line may assign I3 or I4: by name, by a range, a list or an index.
bool may_change_framing(std::string_view line);
bool has_control_characters(std::string_view line);  // each may be answered by itself, or repeat another line
bool may_restart(std::string_view line);             // $$$ or $$$*** anywhere in it
bool may_take_long(std::string_view line);           // SAVE

struct FramingAnswer {
  std::size_t begin, end;  // what stands around it belongs to something else
  Framing framing;
};
// All that looks like an answer from `from` on. What a program sends may look like one too, if it has no tag (I64).
std::vector<FramingAnswer> framing_answers(std::string_view text, std::size_t from);
// Errors, of programs too, have no checksum where other lines have one.
bool may_be_error(std::string_view line);
char sum_of(std::string_view bytes);
bool may_end_answer(std::string_view text);  // its last character is the CR of one

}  // namespace brick
