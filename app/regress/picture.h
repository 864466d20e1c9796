// A stretch of a waveform as a picture: the signals of a GTKWave view, as SVG that stands alone.
#pragma once

#include <string>

namespace brick::regress {

// `wave`: file in FST. `view`: GTKWave's save file. `at_ms`: marked. "" where the waveform has nothing of the view.
std::string picture_of(const std::string& wave, const std::string& view, double at_ms);

}  // namespace brick::regress
