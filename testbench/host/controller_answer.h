// The controller's answer to one line or control character as it comes out of the host port: where it ends, and what of
// it are checksums (I4), which a client never sees (ethernet:4). Nobody says whether there are any, so the bytes are
// read in both ways side by side until one of them cannot be. Without time: whoever feeds it says when nothing came.
#pragma once

#include <cstdint>
#include <string>

namespace brick {

class ControllerAnswer {
 public:
  // `sum`: checksum of what is answered. `sums`: the answer before this one had checksums.
  explicit ControllerAnswer(std::uint8_t sum = 0, bool sums = false)
      : plain_(false, sum), summed_(true, sum), expects_sums_(sums) {}

  void take(std::uint8_t c);
  void quiet();                 // nothing more comes: it has ended
  bool ended() const;           // by its form, or by quiet()
  bool may_have_ended() const;  // it has, if nothing comes for a moment
  std::string release();        // more of the text: what is certain so far, all of it at the end

  bool empty() const { return empty_; }
  bool had_sums() const { return choice_ == Choice::kSummed; }
  bool error() const { return chosen().error; }
  unsigned error_number() const;  // 0: none was given

 private:
  enum class Choice { kOpen, kPlain, kSummed };
  enum class Place { kText, kError, kLineSum, kCommandSum, kEnd };

  struct Reading {  // one of the ways
    Reading(bool has_sums, std::uint8_t command) : sums(has_sums), command_sum(command) {}
    void take(std::uint8_t c);
    void take_text(std::uint8_t c);
    void take_error(std::uint8_t c);
    void take_sum(std::uint8_t c, std::uint8_t expected, Place next);
    bool ends_with_line_feed(bool sum_behind) const;

    bool sums;
    std::uint8_t command_sum, line_sum = 0;
    Place place = Place::kText;
    bool wrong = false, error = false;
    unsigned right_sums = 0;
    std::string text, error_text;
  };

  void decide();
  const Reading& chosen() const { return choice_ == Choice::kSummed ? summed_ : plain_; }

  Reading plain_, summed_;
  Choice choice_ = Choice::kOpen;
  bool expects_sums_, ended_ = false, empty_ = true;
  std::size_t released_ = 0;
};

}  // namespace brick
