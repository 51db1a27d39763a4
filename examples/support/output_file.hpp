// Output files that are there whole or not at all.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <system_error>
#include <vector>

#include "support/failure.hpp"

namespace support {

/// A C file as a stream buffer. The one of libstdc++ 12's ofstream writes past its end where a disk is full.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(const std::string& path) : file_(std::fopen(path.c_str(), "wb"), &std::fclose) {
    setp(memory_.data(), memory_.data() + memory_.size());
  }

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }

  /// True if all that was put has been written.
  [[nodiscard]] bool close() {
    sync();
    return std::fclose(file_.release()) == 0 && good_;
  }

 protected:
  int_type overflow(int_type c) override {
    sync();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    return sputc(traits_type::to_char_type(c));
  }
  int sync() override {
    const auto count = static_cast<std::size_t>(pptr() - pbase());
    good_ = std::fwrite(pbase(), 1, count, file_.get()) == count && good_;
    setp(memory_.data(), memory_.data() + memory_.size());
    return good_ ? 0 : -1;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<char> memory_ = std::vector<char>(std::size_t{1} << 16);
  bool good_ = true;
};

/// Writes beside the wanted file, and takes its place on `commit`; without that, nothing stays behind. What
/// is there and is no plain file, a pipe, a device or a link, is written as it stands.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path) : path_(path) {
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(path_, ignored);
    const bool exists = std::filesystem::exists(status);
    if (std::filesystem::is_directory(path_, ignored)) throw Failure(Exit::other, path_ + ": is a directory");
    if (exists && ::access(path_.c_str(), W_OK) != 0) refuse();
    if (!exists || std::filesystem::is_regular_file(status)) part_ = path_ + ".part";
    buffer_ = std::make_unique<FileBuffer>(part_.empty() ? path_ : part_);
    if (!buffer_->is_open()) refuse();
    stream_.rdbuf(buffer_.get());
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove(part_, ignored);
  }

  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Ends the writing. Throws where something could not be written, while the wanted file is as it was.
  void finish() {
    if (!buffer_->close()) refuse();
  }

  void commit() {
    std::error_code error;
    if (!part_.empty()) std::filesystem::rename(part_, path_, error);
    if (error) refuse();
  }

 private:
  [[noreturn]] void refuse() const { throw Failure(Exit::other, path_ + ": cannot be written"); }

  std::string path_;
  std::string part_;  ///< none for what is written as it stands
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
