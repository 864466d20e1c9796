// Takes the controller's answer to one line apart, byte by byte: data lines, acknowledge, error, checksum bytes
// (host-bus:8.1 to host-bus:8.4, firmware:6.2, firmware:6.3, firmware:6.5, firmware:6.7). Knows no time: whoever owns
// it says when the line has gone quiet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace brick {

// What I3, I4 and I6 say about the form of an answer.
struct Framing {
  unsigned i3 = 1;
  unsigned i4 = 1;
  unsigned i6 = 1;
  bool checksums() const { return i4 & 1; }
};

struct Reply {
  std::vector<std::string>
      lines;  // data lines without framing, error as "ERRnnn" in the last one ("ERR" when I6 sends no number)
  std::vector<std::string> unsolicited;  // lines that a program sent, tagged by <CTRL-B> (I64)
  std::string raw;                       // every byte received
  bool error = false;                    // BELL was received
  bool complete = false;                 // false: time-out
};

class ReplyParser {
 public:
  explicit ReplyParser(Framing framing) : framing_(framing) {}

  void take(std::uint8_t byte);
  bool complete() const { return reply_.complete; }  // the framing itself says that nothing more comes

  // Nothing has come for a while: true when the answer is complete with that (I3 = 0 and 1 have no other end).
  bool quiet();

  const Reply& reply() const { return reply_; }

 private:
  void end_line();

  Framing framing_;
  Reply reply_;
  std::string line_;
  bool tagged_ = false;     // the line began with <CTRL-B>
  bool skip_ = false;       // the next byte is a checksum
  bool last_ = false;       // nothing comes after that checksum
  bool handshake_ = false;  // I3 = 1: the last thing was a LF, with its checksum if any
};

}  // namespace brick
