#pragma once
// Folders that results go into.

#include <filesystem>

namespace crossdem {

/// A folder that this call may write into: it is made, or exists and is empty. Throws FileError.
void claim_folder(const std::filesystem::path& folder);

/// While it lives, no other process holds one of the same folder; a process that was killed holds none.
class FolderLock {
 public:
  /// Makes the folder if there is none. Throws FileError where another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace crossdem
