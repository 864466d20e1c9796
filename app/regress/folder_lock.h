// Keeps a second `brick regress` out of a folder of results for as long as this one works there.
#pragma once

#include <string>

namespace brick::regress {

class FolderLock {
 public:
  // Makes the folder. Throws UsageError when another one works there, or nothing can be written.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_;
};

}  // namespace brick::regress
