// How the FST library gets the content of the files beside the waveform (names, positions, times): copied, never
// mapped. Behind the end of a mapped file that found no room for all of its bytes stands SIGBUS, not an error.
#pragma once

namespace brick {

// Files that ended before what the library had written there, since the last call, in this thread.
unsigned take_short_fst_files();

}  // namespace brick
