// `toothpath reference job|machine`: all keys of the files that people write, as a page or as a schema.
#include <fmt/format.h>

#include "app/commands/command.h"
#include "app/reference/markdown.h"
#include "app/reference/schema.h"

namespace toothpath::commands {
namespace {

struct ReferenceRequest : CommonRequest {
  bool schema = false, markdown = false;
};

Command reference_of(const char* name, const char* description, std::string (*markdown)(), std::string (*schema)()) {
  return command_of<ReferenceRequest>(
      name, description,
      [words = fmt::format("reference {}", name)](OptionSet& set, ReferenceRequest& request) {
        set.examples({(words + " > keys.md").c_str(), (words + " --schema > schema.json").c_str()});
        set.flag("--markdown", request.markdown, "as a page in Markdown; also without this option");
        set.flag("--schema", request.schema, "as a JSON schema (draft 7), for TOML language servers");
      },
      [markdown, schema](const ReferenceRequest& request) {
        if (request.schema && request.markdown)
          return failed(Diagnostic{DiagnosticKind::usage, {}, "--markdown and --schema contradict each other"});
        CommandOutcome outcome;
        outcome.report_json = schema();
        outcome.summary = request.schema ? outcome.report_json : markdown();
        return outcome;
      },
      &kReferences);
}

}  // namespace

void add_reference(Commands& commands) {
  commands.push_back(reference_of("job", "all keys of a job file", reference::job_markdown, reference::job_schema));
  commands.push_back(
      reference_of("machine", "all keys of a machine file", reference::machine_markdown, reference::machine_schema));
}

}  // namespace toothpath::commands
