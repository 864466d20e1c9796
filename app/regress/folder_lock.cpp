#include "app/regress/folder_lock.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick::regress {

// A lock of lockf() is of this process alone: runs do not inherit it, and with us it ends, whatever kills us.
FolderLock::FolderLock(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  file_ = open((folder + "/lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (failed || file_ < 0)
    throw UsageError(fmt::format("--output {}: cannot be written; expected a folder with room for results", folder));
  if (lockf(file_, F_TLOCK, 0) == 0 || (errno != EACCES && errno != EAGAIN)) return;  // or no locks in that file system
  close(file_);
  throw UsageError(
      fmt::format("--output {}: another brick regress works there; expected another folder, or its end", folder));
}

FolderLock::~FolderLock() { close(file_); }

}  // namespace brick::regress
