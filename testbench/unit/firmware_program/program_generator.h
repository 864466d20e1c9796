// Random programs: whatever the statement table and the grammar of docs/language.md can produce, in any spelling that a
// host may use. Blocks are closed.
#pragma once

#include <random>
#include <set>
#include <string>
#include <vector>

#include "testbench/unit/firmware_program/platform.h"

class ProgramGenerator {
 public:
  ProgramGenerator(unsigned seed, std::uint32_t where) : random_(seed), where_(where) {}
  std::vector<std::string> program(unsigned statements);
  std::string statement();                                             // one line
  std::string long_line();                                             // of as many statements as 255 characters hold
  const std::set<std::string>& produced() const { return produced_; }  // names of the table

 private:
  unsigned number(unsigned count) { return std::uniform_int_distribution<unsigned>(0, count - 1)(random_); }
  bool is_motion() const { return (where_ & WHERE_PROG) != 0; }
  std::string constant(bool with_sign);
  std::string expression(unsigned depth);
  std::string value(bool with_sign);
  std::string condition();
  std::string argument(const statement_row& row);
  std::string name(const statement_row& row);
  std::string address(unsigned count);
  std::string assignment();
  std::string called_letter();
  std::string simple(bool first);
  std::string growing();
  std::string simple_line();
  void block(unsigned depth, std::vector<std::string>& lines);
  std::string in_brackets(const std::vector<std::string>& letters);
  std::string numbers(unsigned first, unsigned last);

  std::mt19937 random_;
  std::uint32_t where_;
  bool called_ = false;
  std::set<std::string> produced_;
};
