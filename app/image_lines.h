// The line table of an image: which line of the sources each instruction was made of, as binutils read it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace brick {

// Calls `take` with each instruction of the ELF file, by address. `option` is for messages. Throws UsageError.
void need_disassembler(const std::string& option);  // throws UsageError when it is not there
void image_lines(const std::string& option, const std::string& image,
                 const std::function<void(std::uint32_t address, const std::string& path, unsigned line)>& take);

}  // namespace brick
