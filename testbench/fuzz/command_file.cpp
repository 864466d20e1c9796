// Command files and host scripts: whatever stands in them, they are read in order, or there is one error that begins
// with file and line, says what was expected, and is short and readable.
#include <sstream>
#include <string>

#include "app/byte_text.h"
#include "app/command_file.h"
#include "app/script.h"
#include "testbench/fuzz/target.h"

namespace brick {
namespace {

constexpr std::size_t kLongestError = 2000;

void check(const ScriptLine& line) {
  using Kind = ScriptLine::Kind;
  require(line.place.rfind("fuzz.pmc:", 0) == 0 && line.included.empty(), "a line without its place");
  require(!line.text.empty() && line.text.front() != ' ', "a line of nothing");
  for (const char c : {'\0', '\r', '\n'})
    require(line.text.find(c) == std::string::npos, "a line with a character that ends it");
  const bool sent = line.kind == Kind::kCommand || line.kind == Kind::kControl;
  require(sent != (line.text[0] == '@'), "an @ line is sent, or a line is not");
}

void check(const std::string& error) {
  require(error.rfind("fuzz.pmc:", 0) == 0 && error.find("expected") != std::string::npos,
          "an error that says nothing");
  require(error.size() < kLongestError, "an endless error");
  require(readable_text(error) == error, "an error that acts on a terminal");
}

}  // namespace
}  // namespace brick

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    for (const brick::ScriptLine& line : brick::read_script(in, "fuzz.pmc")) brick::check(line);
  } catch (const brick::UsageError& e) { brick::check(std::string(e.what())); }
  return 0;
}
