#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "text_file.hpp"

namespace crossdem {
namespace {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made: " + error.message());
}

}  // namespace

void claim_folder(const std::filesystem::path& folder) {
  make_folder(folder);
  std::error_code error;
  if (!std::filesystem::is_empty(folder, error) || error)
    throw FileError(folder, "is not an empty folder; nothing was written");
}

FolderLock::FolderLock(const std::filesystem::path& folder) {
  make_folder(folder);
  descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) throw FileError(folder, std::string("cannot be opened: ") + std::strerror(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // or there are no locks here
  close(descriptor_);
  throw FileError(folder, "another crossdem-solver is writing into it; wait until it has ended");
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace crossdem
