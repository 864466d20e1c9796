// Where `brick` finds what belongs to it: beside the executable in a build folder, in share/brick when installed.
#pragma once

#include <string>
#include <vector>

namespace brick {

std::string default_firmware();          // turbo.elf; throws UsageError when there is none
std::string default_firmware_if_any();   // the same, "" when there is none
std::string boards_folder();             // throws UsageError when there is none
std::vector<std::string> board_names();  // of the boards folder, sorted
// NAME of the boards folder, or FILE.toml; `option` begins the message when there is none.
std::string board_path(const std::string& name_or_file, const std::string& option = "--board");

// What stands ready for motors, in share/brick/plants and share/brick/setups: NAME of a file there, or a file. A
// plant's file ends in .toml; a set-up that has a dot or a slash in its name is a file.
std::vector<std::string> plant_names();  // "none" is not among them
std::string plant_path(const std::string& name_or_file);
std::string setup_path(const std::string& name_or_file);

std::string view_path(const std::string& bench);  // its GTKWave save file, in share/brick/waves; "" where there is none

}  // namespace brick
