// JSON schemas (draft 7) of the files that people write, for editors and for tests.
#pragma once

#include <string>

namespace toothpath::reference {

/// docs/schema/job.schema.json.
[[nodiscard]] std::string job_schema();
/// docs/schema/machine.schema.json: milling machines and gear shapers.
[[nodiscard]] std::string machine_schema();

}  // namespace toothpath::reference
