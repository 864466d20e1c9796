// The controller's answer to one line or control character as it comes out of the host port: where it ends, and what of
// it are checksums (I4), which a client never sees (ethernet:4). Nobody says whether there are any, so two parsers read
// the bytes side by side, one with and one without, until one of them cannot be right. Without time: whoever feeds it
// says when nothing came.
#pragma once

#include <cstdint>
#include <string>

#include "testbench/host/reply_parser.h"

namespace brick {

class ControllerAnswer {
 public:
  // `sum`: checksum of what is answered. `sums`: the answer before this one had checksums.
  explicit ControllerAnswer(std::uint8_t sum = 0, bool sums = false)
      : plain_(ReplyParser::any_framing(false, sum)),
        summed_(ReplyParser::any_framing(true, sum)),
        command_sum_(sum),
        expects_sums_(sums) {}

  void take(std::uint8_t c);
  void quiet();                 // nothing more comes: it has ended
  bool ended() const;           // by its form, or by quiet()
  bool may_have_ended() const;  // it has, if nothing comes for a moment
  std::string release();        // more of the text: what is certain so far, all of it at the end

  bool empty() const { return empty_; }
  bool had_sums() const { return choice_ == Choice::kSummed; }
  bool error() const { return chosen().reply().error; }
  unsigned error_number() const { return chosen().error_number(); }  // 0: none was given

 private:
  enum class Choice { kOpen, kPlain, kSummed };

  void decide();
  bool ends_with_checksum(const ReplyParser& parser) const;  // the command's, behind the LF that is the end with I3 = 1
  const ReplyParser& chosen() const { return choice_ == Choice::kSummed ? summed_ : plain_; }

  ReplyParser plain_, summed_;
  Choice choice_ = Choice::kOpen;
  std::uint8_t command_sum_;
  bool expects_sums_, ended_ = false, empty_ = true;
  bool drops_last_ = false;  // the last character is that checksum
  std::size_t released_ = 0;
};

}  // namespace brick
