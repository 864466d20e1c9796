// The bus-timing report of a run as text, as data and as a figure: `brick timing`, docs/timing.md.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "testbench/checkers/timing_book.h"
#include "testbench/checkers/timing_profile.h"

namespace brick {

std::string timing_table(const TimingBook& book);
std::string timing_spans(const TimingProfile& profile);
std::string timing_load(const TimingProfile& profile, TimeFs run);

nlohmann::json timing_json(const TimingBook& book, const TimingProfile& profile, TimeFs run);

// WaveDrom source of a cycle, a quarter of a CPU clock a step. `caption` stands above it.
nlohmann::json timing_figure(const PinCycle& cycle, const std::string& caption);

}  // namespace brick
