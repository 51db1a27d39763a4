// Lines of a stream, in memory that does not grow with the program (set-up).
#pragma once

#include <array>
#include <cstring>
#include <istream>
#include <optional>
#include <string_view>

#include "cncplan/gcode/detail/scanner.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// The lines of a stream, as `TextLines` has them, read in pieces into a buffer of fixed size. Of a comment
/// that does not fit the text is left out, so that columns behind it are too small, and a comment within it
/// is not seen. A line that does not fit for its words is cut: it is longer than the reader accepts anyway,
/// and the reader says so.
class StreamLines {
 public:
  explicit StreamLines(std::istream& stream) : stream_(stream), start_(stream.tellg()) {}

  StreamLines(const StreamLines&) = delete;  // two cannot share a stream
  StreamLines& operator=(const StreamLines&) = delete;

  [[nodiscard]] std::optional<std::string_view> next() {
    for (;;) {
      const std::string_view text(buffer_.data() + begin_, end_ - begin_);
      const std::string_view line = text.substr(0, detail::find_line_end(text));
      const bool open = text.size() < line.size() + longest_line_end && !stream_at_end_;
      if (open && (text.size() < buffer_.size() || (line.size() == text.size() && leave_comment_out()))) {
        refill();
        continue;
      }
      if (text.empty()) return std::nullopt;
      const std::size_t line_end = detail::line_end_length(text.substr(line.size()));
      begin_ += line.size() + line_end;
      const bool remainder = cut_;
      cut_ = line_end == 0 && !stream_at_end_;
      if (!remainder) return line;
    }
  }

  /// Of the line that comes next.
  [[nodiscard]] std::size_t place() const { return before_ + begin_; }
  /// False for a stream that cannot go there, as a pipe.
  bool seek(std::size_t place) {
    cut_ = false;
    if (place >= before_ && place <= before_ + end_) {
      begin_ = place - before_;
      return true;
    }
    stream_.clear();
    if (start_ == std::istream::pos_type(-1) || !stream_.seekg(start_ + static_cast<std::streamoff>(place)))
      return false;
    before_ = place;
    begin_ = end_ = 0;
    stream_at_end_ = false;
    return true;
  }

 private:
  /// Of the comment that is open at the end of a full buffer leaves what begins it; false where none is.
  bool leave_comment_out() {
    const std::string_view text(buffer_.data(), buffer_.size());
    std::size_t at = text.find_first_of("(;");
    while (at != std::string_view::npos && text[at] == '(') {
      const std::size_t behind = comment_end(text, at);
      if (behind == std::string_view::npos) break;
      at = text.find_first_of("(;", behind);
    }
    if (at == std::string_view::npos || at + 1 == text.size()) return false;
    begin_ = text.size() - (at + 1);
    std::memmove(buffer_.data() + begin_, buffer_.data(), at + 1);
    return true;
  }

  void refill() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    before_ += begin_;
    end_ -= begin_;
    begin_ = 0;
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    end_ += static_cast<std::size_t>(stream_.gcount());
    stream_at_end_ = !stream_;
  }

  static constexpr std::size_t longest_line_end = 3;

  std::istream& stream_;
  std::istream::pos_type start_;
  std::size_t before_{};  ///< bytes of the stream before the buffer
  std::size_t begin_{};
  std::size_t end_{};
  bool stream_at_end_{};
  bool cut_{};  ///< the line before was cut: what comes next is the rest of it
  std::array<char, 1U << 16U> buffer_;
  static_assert(sizeof(buffer_) > max_line_length + 2);
};

static_assert(SeekableLines<StreamLines>);

}  // namespace cncplan::gcode
