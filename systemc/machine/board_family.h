// Families of products: what can be fitted on a board of each, and what follows from the family. The rules behind the
// checks of board_file.h; docs/boards.md has them as a table.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace brick {

struct BoardFamily {
  std::string_view name;   // value of the key `family`
  std::uint32_t allowed;   // ICs that such a board can have, bits as BoardInputs::fitted
  std::string_view ics;    // the same in words
  bool jpan;               // can have the control panel port
  bool feedback_option_2;  // can have the SSI inputs of Feedback Option 2
  std::uint8_t ssi_kind;   // serial encoder inputs that every such board has
  std::uint32_t product;   // bits of the straps page, Product below
  std::string_view type;   // answer to TYPE, up to the comma
  bool control_outputs;    // interrupt lines can come from CTRL0, CTRL1
  bool outside_lines;      // ... from MI1, MI2 of JOPTO and AXEXP0, AXEXP1 of an axis expansion board
  bool amplifiers;         // are built in
};

// Word 5 of the straps page (docs/architecture.md).
enum Product : std::uint32_t {
  kProductJpan = 1,
  kProductUmac = 2,
  kProductUltralite = 4,
  kProductTurboPmac1 = 8,
  kProductFeedback2 = 16,
  kProductGeoPmac = 32
};

// Straps::ssi_kind. A Geo PMAC without the option has the page of addresses, and both bits.
constexpr std::uint8_t kSsiGeoPmac = 1, kSsiGeoBrick = 2;

const BoardFamily* find_board_family(std::string_view name);  // nullptr: no such family
std::vector<std::string> board_family_names();

// Sources of the interrupt controller's lines IR5, IR6 and IR7, by their code in BoardInputs::line_select.
constexpr std::array<std::string_view, 16> kInterruptSources{"none", "EQU1", "EQU2",   "EQU3",  "EQU4",  "EQU5",
                                                             "EQU6", "EQU7", "EQU8",   "WDO",   "CTRL0", "CTRL1",
                                                             "MI1",  "MI2",  "AXEXP0", "AXEXP1"};
constexpr unsigned kSourceEqu8 = 8, kSourceWdo = 9, kSourceCtrl0 = 10, kSourceCtrl1 = 11, kSourceMi1 = 12;

// Names of the fitted ICs, e.g. "servo IC 0", "servo IC 2*", "MACRO IC 0", in the order of BoardInputs::fitted.
std::vector<std::string> fitted_ic_names(std::uint32_t fitted);
std::string servo_ic_numbers(std::uint32_t fitted);  // "0 1 2*", "-" when there is none
std::string macro_ic_numbers(std::uint32_t fitted);

// I19 after re-initialisation; 0 when no fitted IC can make the clocks (a MACROGATE cannot).
unsigned default_clock_source(std::uint32_t fitted, std::uint32_t macro_gate);

}  // namespace brick
