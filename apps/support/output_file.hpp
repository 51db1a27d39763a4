// Output files that are there whole or not at all.
#pragma once

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "support/failure.hpp"

namespace support {

/// The name that stands for standard output.
inline constexpr std::string_view standard_output = "-";

/// A C file as a stream buffer; standard output stays open. The one of libstdc++ 12's ofstream writes past
/// its end where a disk is full.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(const std::string& path)
      : file_(path == standard_output ? File(stdout, &std::fflush)
                                      : File(std::fopen(path.c_str(), "wb"), &std::fclose)) {
    setp(memory_.data(), memory_.data() + memory_.size());
  }

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }

  /// 0 if all that was put has been written, else the error number of what went wrong first.
  [[nodiscard]] int close() {
    sync();
    const auto end = file_.get_deleter();
    if (end(file_.release()) != 0 && error_ == 0) error_ = errno;
    return error_;
  }

 protected:
  int_type overflow(int_type c) override {
    sync();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    return sputc(traits_type::to_char_type(c));
  }
  int sync() override {
    const auto count = static_cast<std::size_t>(pptr() - pbase());
    if (std::fwrite(pbase(), 1, count, file_.get()) != count && error_ == 0) error_ = errno;
    setp(memory_.data(), memory_.data() + memory_.size());
    return error_ == 0 ? 0 : -1;
  }

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  File file_;
  std::vector<char> memory_ = std::vector<char>(std::size_t{1} << 16);
  int error_ = 0;
};

/// The name of a file that is removed with this object, or where a signal ends the program. No more than 32
/// at once are removed by signals.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::string path) : path_(std::move(path)) {
    [[maybe_unused]] static const bool armed = arm();
    for (std::atomic<const char*>& name : names) {
      const char* none = nullptr;
      if (name.compare_exchange_strong(none, path_.c_str())) return;
    }
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile() {
    for (std::atomic<const char*>& name : names)
      if (name == path_.c_str()) name = nullptr;
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  // A handler may do little: to remove files and to end as without it is allowed. Another signal waits until
  // it has done so, as `timeout` sends each one twice.
  static void clean_up(int signal) {
    for (const std::atomic<const char*>& name : names)
      if (const char* const file = name) ::unlink(file);
    std::signal(signal, SIG_DFL);
    ::raise(signal);
  }
  static bool arm() {
    struct sigaction action {};
    action.sa_handler = &clean_up;
    for (const int signal : ends) ::sigaddset(&action.sa_mask, signal);
    for (const int signal : ends) {
      struct sigaction before {};
      if (::sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;  // nohup
      ::sigaction(signal, &action, nullptr);
    }
    return true;
  }

  static constexpr std::array<int, 3> ends{SIGINT, SIGTERM, SIGHUP};
  static inline std::array<std::atomic<const char*>, 32> names{};

  std::string path_;
};

/// Writes beside the wanted file, and takes its place on `commit`; without that, nothing stays behind. What
/// is there and is no plain file, a pipe, a device or a link, is written as it stands, and so is standard
/// output.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path) : path_(path) {
    if (path_ != standard_output) look_at_place();
    buffer_ = std::make_unique<FileBuffer>(part_ ? part_->path() : path_);
    if (!buffer_->is_open()) refuse(errno);
    stream_.rdbuf(buffer_.get());
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Ends the writing. Throws where something could not be written, while the wanted file is as it was.
  void finish() {
    if (const int error = buffer_->close()) refuse(error);
  }

  void commit() {
    std::error_code error;
    if (part_) std::filesystem::rename(part_->path(), path_, error);
    if (error) refuse(error.value());
  }

 private:
  void look_at_place() {
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(path_, ignored);
    const bool exists = std::filesystem::exists(status);
    if (std::filesystem::is_directory(path_, ignored)) throw Failure(Exit::other, path_ + ": is a directory");
    if (exists && ::access(path_.c_str(), W_OK) != 0) refuse(errno);
    if (!exists || std::filesystem::is_regular_file(status)) part_.emplace(path_ + ".part");
  }

  [[noreturn]] void refuse(int error) const {
    const std::string name = path_ == standard_output ? "standard output" : path_;
    throw Failure(Exit::other, name + ": cannot be written: " + std::generic_category().message(error));
  }

  std::string path_;
  std::optional<UnfinishedFile> part_;  ///< none for what is written as it stands
  std::unique_ptr<FileBuffer> buffer_;
  std::ostream stream_{nullptr};
};

/// Files that appear together, when all is done.
class OutputFiles {
 public:
  /// Where to write; null without a path.
  [[nodiscard]] std::ostream* open(const std::optional<std::string>& path) {
    return path ? &files_.emplace_back(std::make_unique<OutputFile>(*path))->stream() : nullptr;
  }

  void finish() {
    for (const auto& file : files_) file->finish();
  }
  void commit() {
    for (const auto& file : files_) file->commit();
  }

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

}  // namespace support
