// The rules of size: no function body above 60 lines without a reason in its comment, no public function with 8
// parameters, no room with more than 30 files. What counts functions is itself tested on text with planted faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceRoot = TOOTHPATH_SOURCE_DIR;
constexpr int kLongestBody = 60, kMostParameters = 7, kMostFiles = 30;
/// What the comment of a longer function says, with the reason behind it.
constexpr std::string_view kReason = "Long because ";

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The same text with comments, directives, and what stands in strings and characters as blanks: every line and column
/// stays.
std::string blanked(std::string_view text) {
  std::string out(text);
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < std::min(to, out.size()); ++k)
      if (out[k] != '\n') out[k] = ' ';
  };
  const auto end_of = [&](std::string_view what, std::size_t from) {
    return std::min(text.find(what, from), text.size());
  };
  bool line_begins = true;
  for (std::size_t k = 0; k < text.size();) {
    std::size_t end = k + 1;
    const char c = text[k];
    if (line_begins && c == '#') {
      end = end_of("\n", k);
      while (end < text.size() && text[end - 1] == '\\') end = end_of("\n", end + 1);
    } else if (text.substr(k, 2) == "//") {
      end = end_of("\n", k);
    } else if (text.substr(k, 2) == "/*") {
      end = end_of("*/", k + 2) + 2;
    } else if (c == '"' && k > 0 && text[k - 1] == 'R') {
      const std::string close = ")" + std::string(text.substr(k + 1, end_of("(", k) - k - 1)) + "\"";
      end = end_of(close, k) + close.size();
    } else if (c == '"' || (c == '\'' && !(k > 0 && is_word(text[k - 1])))) {  // not the ' of 1'000
      while (end < text.size() && text[end] != c) end += text[end] == '\\' ? 2 : 1;
      ++end;
    }
    if (end > k + 1) blank(k, end);
    else if (std::isspace(static_cast<unsigned char>(c)) == 0) line_begins = false;
    if (c == '\n') line_begins = true;
    k = end;
  }
  return out;
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front())) != 0) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back())) != 0) s.remove_suffix(1);
  return s;
}
bool ends_with_word(std::string_view s, std::string_view word) {
  return s.ends_with(word) && (s.size() == word.size() || !is_word(s[s.size() - word.size() - 1]));
}
int line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Is `{` behind this text the beginning of a body (of a function, a lambda, or a block in one)?
bool begins_body(std::string_view head) {
  head = trimmed(head);
  for (const char* word : {"const", "override", "noexcept", "final", "mutable", "else", "do", "try"})
    if (ends_with_word(head, word)) return true;
  const std::size_t arrow = head.rfind("->");
  return head.ends_with(')') || head.ends_with(']') || head.ends_with('}') ||
         (arrow != std::string_view::npos && head.find(')', arrow) == std::string_view::npos);
}

struct Body {
  int line = 0, lines = 0;  ///< of the brace that opens it; from there to the one that closes it
  bool explained = false;
};

/// Bodies of more than `most` lines that lie in no other such body.
std::vector<Body> long_bodies(std::string_view text, int most) {
  const std::string bare = blanked(text);
  struct Open {
    std::size_t at, head;  ///< the brace, and where the statement that it belongs to begins
  };
  std::vector<Open> open;
  std::vector<Body> found;
  std::vector<std::size_t> begins;  // of the bodies found
  std::size_t head = 0;
  for (std::size_t k = 0; k < bare.size(); ++k) {
    if (bare[k] == ';') head = k + 1;
    if (bare[k] == '{') {
      open.push_back({k, head});
      head = k + 1;
    }
    if (bare[k] != '}' || open.empty()) continue;
    const Open o = open.back();
    open.pop_back();
    head = o.head;  // braces of an initializer belong to the statement around them
    const std::string_view before = std::string_view(bare).substr(o.head, o.at - o.head);
    if (!begins_body(before)) {
      const std::string_view next = trimmed(std::string_view(bare).substr(k + 1, 200)), kind = trimmed(before);
      if (next.starts_with(';') || kind.empty() || kind.starts_with("namespace")) head = k + 1;
      continue;
    }
    head = k + 1;
    const int from = line_of(bare, o.at), lines = line_of(bare, k) - from + 1;
    if (lines <= most) continue;
    while (!begins.empty() && begins.back() > o.at) {  // what lies inside
      begins.pop_back();
      found.pop_back();
    }
    begins.push_back(o.at);
    found.push_back({from, lines, text.substr(o.head, o.at - o.head).find(kReason) != std::string_view::npos});
  }
  return found;
}

struct Signature {
  int line = 0, parameters = 0;
  std::string name;
};

int parameters_of(std::string_view list) {
  if (trimmed(list).empty()) return 0;
  int count = 1, depth = 0, angle = 0;
  for (const char c : list) {
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (depth == 0 && c == '<') ++angle;
    if (depth == 0 && c == '>') --angle;
    if (depth == 0 && angle <= 0 && c == ',') ++count;
  }
  return count;
}

/// Functions and constructors that a header offers to everybody.
std::vector<Signature> public_functions(std::string_view text) {
  const std::string bare = blanked(text);
  struct Scope {
    bool declares, hidden;  ///< namespace or class; behind `private:` or `protected:`
  };
  std::vector<Scope> scopes;
  std::vector<Signature> found;
  std::size_t head = 0;
  const auto shown = [&] {
    return std::all_of(scopes.begin(), scopes.end(), [](const Scope& s) { return s.declares && !s.hidden; });
  };
  for (std::size_t k = 0; k < bare.size(); ++k) {
    const std::string_view before = std::string_view(bare).substr(head, k - head);
    switch (bare[k]) {
      case ';': head = k + 1; break;
      case '}':
        if (!scopes.empty()) scopes.pop_back();
        head = k + 1;
        break;
      case ':':
        if (!scopes.empty() && (ends_with_word(before, "private") || ends_with_word(before, "protected")))
          scopes.back().hidden = true;
        if (!scopes.empty() && ends_with_word(before, "public")) scopes.back().hidden = false;
        break;
      case '{': {
        const std::string_view statement = trimmed(before);
        const auto has = [&](std::string_view word) {
          return (" " + std::string(statement)).find(" " + std::string(word) + " ") != std::string::npos;
        };
        const bool names = statement.starts_with("namespace"), type = has("class") || has("struct");
        scopes.push_back({names || (type && !statement.ends_with(')')), has("class")});
        head = k + 1;
        break;
      }
      case '(': {
        int depth = 1;
        std::size_t end = k + 1;
        for (; end < bare.size() && depth > 0; ++end) depth += bare[end] == '(' ? 1 : bare[end] == ')' ? -1 : 0;
        std::string_view name = trimmed(before);
        std::size_t first = name.size();
        while (first > 0 && is_word(name[first - 1])) --first;
        name = name.substr(first);
        const std::string_view behind = trimmed(before.substr(before.rfind(')') + 1));  // all of it where there is none
        const bool initializer = behind.starts_with(',') || (behind.starts_with(':') && !behind.starts_with("::"));
        if (shown() && !name.empty() && !initializer && before.find('=') == std::string_view::npos)
          found.push_back(
              {line_of(bare, k), parameters_of(std::string_view(bare).substr(k + 1, end - k - 2)), std::string(name)});
        k = end - 1;
        break;
      }
      default: break;
    }
  }
  return found;
}

std::vector<fs::path> sources() {
  std::vector<fs::path> out;
  for (const char* top : {"geometry", "cam", "machines", "postproc", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kSourceRoot / top))
      if (const auto e = entry.path().extension(); e == ".h" || e == ".cpp" || e == ".inl") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Sizes, NoLongFunctionWithoutAReason) {
  for (const fs::path& file : sources())
    for (const Body& body : long_bodies(file_text(file.string()), kLongestBody))
      EXPECT_TRUE(body.explained) << fs::relative(file, kSourceRoot).string() << ":" << body.line << ": a body of "
                                  << body.lines << " lines, at most " << kLongestBody << " without a comment \""
                                  << kReason << "..\"";
}

TEST(Sizes, NoPublicFunctionWithEightParameters) {
  std::size_t seen = 0;
  for (const fs::path& file : sources()) {
    if (file.extension() != ".h") continue;
    for (const Signature& s : public_functions(file_text(file.string()))) {
      ++seen;
      EXPECT_LE(s.parameters, kMostParameters)
          << fs::relative(file, kSourceRoot).string() << ":" << s.line << ": " << s.name << " takes " << s.parameters
          << " parameters: give those that belong together a struct";
    }
  }
  EXPECT_GT(seen, 800u) << "the reader of headers sees next to nothing";
}

TEST(Sizes, NoRoomWithMoreThan30Files) {
  for (const char* top : {"geometry", "cam", "machines", "postproc", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kSourceRoot / top)) {
      if (!entry.is_directory()) continue;
      const auto counts = [](const fs::directory_entry& f) {
        return f.is_regular_file() && f.path().filename() != "README.md" && f.path().filename() != "CMakeLists.txt";
      };
      EXPECT_LE(std::count_if(fs::directory_iterator(entry.path()), fs::directory_iterator(), counts), kMostFiles)
          << fs::relative(entry.path(), kSourceRoot);
    }
}

// The counter itself.

std::string repeated(int n, const std::string& one = "  f();\n") {
  std::string out;
  for (int k = 0; k < n; ++k) out += one;
  return out;
}

TEST(BodyCounter, FindsALongBodyWhateverStandsAroundIt) {
  const std::string filling = repeated(9);  // 11 lines with the braces
  for (const std::string head :
       {"void f() ", "int C::f(int a, std::vector<int> b = {1, 2}) const ", "C::C(int a) : a_{a}, b_(2) ",
        "auto f() -> int ", "bool f() const noexcept\n", "template <typename T>\nvoid f(T)\n",
        "const auto f = [&](int a) ", "const auto f = [] "}) {
    const std::string text = "int before;\n" + head + "{\n" + filling + "}\n";
    const auto found = long_bodies(text, 10);
    ASSERT_EQ(found.size(), 1u) << head;
    EXPECT_EQ(found[0].lines, 11);
    EXPECT_EQ(found[0].line, 2 + std::count(head.begin(), head.end(), '\n')) << head;
    EXPECT_FALSE(found[0].explained);
    EXPECT_TRUE(long_bodies(text, 11).empty()) << head;
  }
}

TEST(BodyCounter, ReadsPastStringsAndComments) {
  for (const char* line :
       {"  s = \"}}\";\n", "  s = \"\\\"}\";\n", "  c = '}';\n", "  c = '\\'';  // don't }\n", "  /* } */ n = 1'000;\n",
        "  s = R\"x(}\")\")x\";\n", "#define CLOSE }\n", "#define LONG \\\n  }\n"})
    EXPECT_EQ(long_bodies("void f() {\n" + repeated(20, line) + "}\nvoid g() {\n}\n", 19).size(), 1u) << line;
}

TEST(BodyCounter, CountsNoTablesClassesOrNamespaces) {
  for (const std::string head : {"namespace a ", "struct S ", "class C : public B<int> ", "enum class E : int ",
                                 "static const std::vector<int> table = ", "constexpr int kTable[] = "}) {
    const std::string text = head + "{\n" + repeated(20, "  {1, 2},\n") + "};\n";
    EXPECT_TRUE(long_bodies(text, 10).empty()) << head;
  }
  EXPECT_TRUE(long_bodies("struct S {\n" + repeated(40, "  void f() { g(); }\n") + "};\n", 10).empty());
}

TEST(BodyCounter, TellsTheOuterOfTwoAndReadsTheReason) {
  const std::string inner = "  if (a) {\n" + repeated(20) + "  }\n";
  const auto two = long_bodies("void f() {\n" + inner + "}\n\nvoid g() {\n" + inner + "}\n", 10);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].line, 1);
  EXPECT_EQ(two[1].line, 26);
  EXPECT_FALSE(two[0].explained || two[1].explained);
  const auto told = long_bodies("/// Adds. Long because a table reads best in one piece.\nvoid f() {\n" + inner +
                                    "}\nvoid g() {\n" + inner + "}\n",
                                10);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_TRUE(told[0].explained);
  EXPECT_FALSE(told[1].explained);
}

TEST(ParameterCounter, CountsWhatAHeaderOffers) {
  const std::string text =
      "namespace a {\n"
      "[[nodiscard]] std::map<int, int> f(const std::map<int, std::pair<int, int>>& a, int b = g(1, 2), "
      "std::function<void(int, int)> c = {});\n"
      "class C {\n  void hidden(int a, int b);\n public:\n  C(int a, int b, int c);\n  explicit C(int a) : a_(a), "
      "b_{a}, c_(a) { use(1, 2, 3, 4); }\n private:\n  int x = h(1, 2);\n};\n"
      "struct S {\n  void open(int a, int b);\n  double v = h(1, 2);\n};\n"
      "inline int body(int a) { return h(a, a, a); }\n"
      "void none();\n}\n";
  std::vector<std::string> found;
  for (const Signature& s : public_functions(text))
    found.push_back(s.name + std::to_string(s.parameters) + "@" + std::to_string(s.line));
  EXPECT_EQ(found, (std::vector<std::string>{"f3@2", "C3@6", "C1@7", "open2@12", "body1@15", "none0@16"}));
}

}  // namespace
}  // namespace toothpath::test
