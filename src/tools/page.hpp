// The parts of the page that shows a report.
#pragma once

#include <string_view>

namespace cncplan::tools::report {

/// `page` is the frame, in which `{{NAME}}` stands for another part: `style`, `three`, `dygraphs`, `scripts`,
/// `licences`. Empty for other names.
[[nodiscard]] std::string_view page_part(std::string_view name);

}  // namespace cncplan::tools::report
