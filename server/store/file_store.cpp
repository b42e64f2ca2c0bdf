#include "server/store/file_store.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace smokemap::server {
namespace {

class FileDescriptor {
 public:
  FileDescriptor(const std::string& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0640)) {}
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  bool ok() const { return fd_ >= 0; }
  bool sync() const { return ::fsync(fd_) == 0; }
  bool write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }

 private:
  int fd_;
};

Error io_error(const std::string& path) {
  return fail(Errc::kIo, path + ": " + (errno == ENOSPC ? "the disk is full" : std::strerror(errno)));
}

}  // namespace

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  ENGINE_EXPECT(EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) == 1);
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += kDigits[digest[i] >> 4];
    hex += kDigits[digest[i] & 15];
  }
  return hex;
}

bool is_sha256_hex(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<FileStore> FileStore::open(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return fail(Errc::kIo, "the folder " + folder + " cannot be made: " + failed.message());
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))  // what a crash left half written
    if (entry.path().extension() == ".part") std::filesystem::remove(entry.path(), failed);
  return FileStore(folder);
}

Result<std::string> FileStore::put(std::string_view bytes) const {
  static std::atomic<unsigned> counter{0};
  const std::string sha = sha256_hex(bytes);
  const std::string path = folder_ + "/" + sha;
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) == bytes.size() && get(sha)) return sha;
  const std::string part = path + "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".part";
  {
    const FileDescriptor file(part, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file.ok() || !file.write_all(bytes) || !file.sync()) {
      const Error error = io_error(part);
      std::filesystem::remove(part, ignored);
      return error;
    }
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    const Error error = io_error(path);
    std::filesystem::remove(part, ignored);
    return error;
  }
  const FileDescriptor folder(folder_, O_RDONLY | O_DIRECTORY);
  if (!folder.ok() || !folder.sync()) return io_error(folder_);
  return sha;
}

Result<std::string> FileStore::get(std::string_view sha256) const {
  if (!is_sha256_hex(sha256)) return fail(Errc::kNotFound, "no file has this name");
  std::ifstream file(folder_ + "/" + std::string(sha256), std::ios::binary);
  if (!file) return fail(Errc::kNotFound, "no file has the hash " + std::string(sha256));
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  if (sha256_hex(bytes) != sha256)
    return fail(Errc::kCorrupt, "the stored file " + std::string(sha256) + " is damaged");
  return bytes;
}

}  // namespace smokemap::server
