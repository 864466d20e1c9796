// What a command line is answered with, by I3 and I4, as firmware:6.2, firmware:6.5 and host-bus:8.3 say: written from
// the data sheet alone, for the firmware natively and for the image.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "testbench/host/reply_parser.h"

namespace brick {

inline char checksum(const std::string& bytes) {
  return static_cast<char>(std::accumulate(bytes.begin(), bytes.end(), 0u,
                                           [](unsigned sum, char c) { return sum + static_cast<unsigned char>(c); }));
}

// A reply line's checksum counts every byte of it, LF and CR too; the command's counts no control characters and
// follows the acknowledgement, so that there is none without one.
inline std::string framed(Framing framing, const std::string& command, const std::vector<std::string>& data) {
  const bool sums = framing.i4 % 2 == 1;
  std::string reply;
  for (const std::string& text : data) {
    const std::string line = (framing.i3 % 2 == 1 ? "\n" : "") + text + "\r";
    reply += line;
    if (sums) reply += checksum(line);
  }
  if (framing.i3 == 0) return reply;
  reply += framing.i3 == 1 ? "\n" : "\x06";
  if (sums) reply += checksum(command);
  return reply;
}

// Calls check(framing, set-up line, command, data) for every setting and a few lines with and without data.
template <typename Check>
void for_each_framing(Check check) {
  struct Line {
    const char* command;
    std::vector<std::string> data;
  };
  const Line lines[] = {
      {"P1", {"25"}}, {"p1..3", {"25", "50", "75"}}, {"P2=50 P3 = 75", {}}, {"ver TYPE", {"1.947", "TURBO2, X4"}}};
  for (unsigned i3 = 0; i3 <= 3; ++i3)
    for (unsigned i4 = 0; i4 <= 3; ++i4)
      for (const Line& line : lines)
        check(Framing{i3, i4}, "P1=25 P2=50 P3=75 I3=" + std::to_string(i3) + " I4=" + std::to_string(i4) + "\r",
              std::string(line.command), line.data);
}

}  // namespace brick
