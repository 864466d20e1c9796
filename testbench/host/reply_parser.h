// Takes the controller's answer to one line apart, byte by byte: data lines, acknowledge, error, checksum bytes
// (host-bus:8.1 to host-bus:8.4, firmware:6.2, firmware:6.3, firmware:6.5, firmware:6.7). Knows no time: whoever owns
// it says when the line has gone quiet.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace brick {

// What I3 and I4 say about the form of an answer. That of an error, I6, shows by itself.
struct Framing {
  unsigned i3, i4;
  bool checksums() const { return (i4 & 1) != 0; }
  bool operator==(const Framing& other) const { return i3 == other.i3 && checksums() == other.checksums(); }
};

struct Reply {
  std::vector<std::string>
      lines;  // data lines without framing, error as "ERRnnn" in the last one ("ERR" when I6 sends no number)
  std::vector<std::string> unsolicited;  // lines that a program sent, tagged by <CTRL-B> (I64)
  std::string raw;                       // every byte received
  std::string bad_checksum;              // what was wrong with the first checksum that was, else empty
  std::string doubt;                     // why it cannot be told what I3 and I4 are now, else empty
  bool error = false;                    // BELL was received
  bool complete = false;                 // false: time-out, or longer than any reply is
};

// Of a line sent to the controller: the sum of its characters, control characters left out (host-bus:8.3/3).
std::uint8_t command_checksum(std::string_view line);

class ReplyParser {
 public:
  // `mixed`: the line may change I3 and I4 half-way, so that only quiet ends the reply, and bytes are taken for
  // checksums where they agree with one, if there were any before or after it; an error, which is the last, may only
  // have one where there are any after it. `command`: the checksum of the line; none: any byte will do.
  enum class Mixed { kNo, kWithoutChecksums, kOfLines, kWithChecksums };
  ReplyParser(Framing framing, std::optional<std::uint8_t> command, Mixed mixed = Mixed::kNo)
      : framing_(framing),
        command_(command),
        mixed_(mixed != Mixed::kNo),
        sums_(framing.checksums() || mixed == Mixed::kOfLines || mixed == Mixed::kWithChecksums),
        error_sums_(sums_ && mixed != Mixed::kOfLines),
        error_ends_(!sums_) {}

  // Of an answer whose I3 nobody knows, on this controller, whose errors have no checksum: whoever reads it finds the
  // end that I3 = 0 and 1 have in text(), and by misread() that there are no checksums, or that there are.
  static ReplyParser any_framing(bool checksums, std::uint8_t command) {
    ReplyParser parser({2, checksums ? 1u : 0u}, command);
    parser.error_sums_ = false;
    parser.error_ends_ = true;
    return parser;
  }

  bool take(std::uint8_t byte);                      // false: it is none of this reply, which is complete
  bool complete() const { return reply_.complete; }  // the framing itself says that nothing more comes

  // Nothing has come for a while: true when the answer is complete with that. I3 = 0 and 1 have no other end, nor have
  // errors without a number and errors among checksums.
  bool quiet();
  bool ends_by_quiet() const { return mixed_ || framing_.i3 < 2 || reply_.error; }

  const Reply& reply() const { return reply_; }
  // All that came but for right checksums; what a complete reply is followed by, too.
  const std::string& text() const { return text_; }
  unsigned right_checksums() const { return right_; }
  bool misread() const { return misread_; }  // a checksum was wrong, or something followed a complete reply
  bool bare_error() const { return reply_.error && !numbered_ && line_.empty(); }  // I6 = 0, 2, if no more comes
  unsigned error_number() const;                                                   // 0: none has come

  // Where no checksums are expected: behind a data line came what would be its checksum, as data may also happen to be.
  bool maybe_checksums() const { return maybe_checksums_; }

 private:
  // Whose checksum may come next. A program's error with its tag (I64) has none on this controller.
  enum class Due { kNothing, kLine, kCommand, kError, kProgramError };

  bool may_be_of_error(std::uint8_t byte) const;
  bool take_checksum(std::uint8_t byte);
  void take_text(char c);
  Due end_line();
  bool quiet_is_the_end();

  Framing framing_;
  std::optional<std::uint8_t> command_;
  bool mixed_, sums_, error_sums_, error_ends_, maybe_checksums_ = false;
  Reply reply_;
  std::string text_;
  unsigned right_ = 0;
  bool misread_ = false;
  std::string line_;
  std::uint8_t sum_ = 0;  // of the line that is being received, or of the last one
  Due due_ = Due::kNothing;
  std::optional<std::uint8_t> unexpected_;  // that checksum, behind a line
  bool tagged_ = false;                     // the line began with <CTRL-B>
  bool numbered_ = false;                   // the number of the error has come
  bool summed_ = false;                     // the last data line had a checksum
  bool handshake_ = false;                  // the last thing was an acknowledge, with or without a checksum
  std::optional<char> held_;  // what came behind it: the command's checksum, or the first character of a line
};

}  // namespace brick
