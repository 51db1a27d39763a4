// A file that is there whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "failure.hpp"

namespace simulate {

/// Writes beside the wanted file, and takes its place on `commit`; without that, nothing stays behind.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path)
      : path_(path), part_(path + ".part"), stream_(part_, std::ios::binary | std::ios::trunc) {
    if (!stream_) throw Failure(Exit::other, path_ + ": cannot be written");
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }

  [[nodiscard]] std::ofstream& stream() { return stream_; }

  void commit() {
    stream_.close();
    std::error_code error;
    if (stream_) std::filesystem::rename(part_, path_, error);
    if (!stream_ || error) throw Failure(Exit::other, path_ + ": cannot be written");
  }

 private:
  std::string path_;
  std::string part_;
  std::ofstream stream_;
};

}  // namespace simulate
