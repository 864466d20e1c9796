// Random program text for `listing`, each statement in three spellings: as a host may send it, and as it is listed in
// short and in long form (firmware:4.8). Only what the rules name is made here, by rules of its own.
#pragma once

#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace brick {

class ProgramText {
 public:
  enum Kind { kMotion, kPlc, kKinematic };

  explicit ProgramText(std::uint64_t seed) : random_(seed * 7919 + 3) {}

  void begin(Kind kind, unsigned statements);  // another program
  void spoil();                                // what is expected of the first line is wrong from now on
  const std::vector<std::string>& sent() const { return sent_; }
  const std::vector<std::string>& listed(bool long_form) const { return long_form ? full_ : brief_; }
  unsigned produced() const { return static_cast<unsigned>(produced_.size()); }  // kinds of statements so far

 private:
  struct Text {
    std::string sent, brief, full;
    bool blank = false;  // one is listed behind it if another statement follows
  };

  unsigned number(unsigned count) { return static_cast<unsigned>(random_() % count); }
  std::string spelled(const std::string& text);
  Text constant();
  Text variable();
  Text expression(unsigned depth);
  Text condition();
  Text keyword(const std::string& brief, const std::string& full);
  Text valued(const std::string& brief, const std::string& full, bool with_sign);
  Text assignment();
  Text simple();
  Text motion();
  void line(unsigned statements);
  void add(const Text& text);
  void block(unsigned depth);

  std::mt19937_64 random_;
  Kind kind_ = kMotion;
  std::vector<std::string> sent_, brief_, full_;
  std::set<std::string> produced_;
};

}  // namespace brick
