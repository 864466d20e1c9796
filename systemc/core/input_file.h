// The one way in which a file that a user names is read as a whole. A named pipe would wait for its writer, a device
// such as /dev/zero has no end: the one is refused, and of every file there is a most. Pipes that the shell has opened
// (/dev/stdin, `<(...)`) are files like others.
#pragma once

#include <cstddef>
#include <string>

namespace brick {

constexpr std::size_t kMostInputMebibytes = 64;

// Throws UsageError: `shown`, by default the path, then what is wrong with it and `expected`.
std::string read_input_file(const std::string& path, const std::string& expected, const std::string& shown = "");

// For what reads the file by its name, perhaps more than once: throws UsageError unless it is a regular one.
void need_regular_file(const std::string& path, const std::string& expected, const std::string& shown = "");

bool is_named_pipe(const std::string& path);

}  // namespace brick
