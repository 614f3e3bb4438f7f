#include "options/documents.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "options/description_tables.hpp"
#include "supple/version.hpp"

namespace supple::cli {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

bool is_documented(const CLI::Option* option) {
  return option->get_positional() || !option->get_group().empty();
}

/// Replaces every `from`.
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// `--threads N`, or the name of a positional.
std::string spelling(const CLI::Option* option) {
  if (option->get_positional()) return fmt::format("{}...", option->get_name(true));
  const std::string names = replaced(option->get_name(false, true), ",", ", ");
  if (option->get_expected_max() == 0) return names;
  return fmt::format("{} {}", names, option->get_type_name());
}

/// `[OPTIONS] MESH...|SCENE.toml`
std::string arguments_of(const CLI::App& command) {
  std::string inputs;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) inputs = option->get_name(true);
  }
  inputs.insert(std::min(inputs.find('|'), inputs.size()), "...");
  return "[OPTIONS] " + inputs;
}

/// An option that several commands have with the same description, which the documents have once.
struct SharedOption {
  const CLI::Option* option = nullptr;
  std::vector<std::string> commands;
};

bool are_same(const CLI::Option* option, const CLI::Option* other) {
  return spelling(option) == spelling(other) && option->get_description() == other->get_description();
}

/// In the order of their first occurrence.
std::vector<SharedOption> shared_options(const CLI::App& program) {
  std::vector<SharedOption> all;
  for (const CLI::App* command : commands_of(program)) {
    for (const CLI::Option* option : command->get_options()) {
      if (!is_documented(option) || option->get_positional()) continue;
      const auto known = std::find_if(all.begin(), all.end(), [&](const SharedOption& shared) {
        return are_same(shared.option, option);
      });
      SharedOption& shared = known == all.end() ? all.emplace_back(SharedOption{option, {}}) : *known;
      shared.commands.push_back(command->get_name());
    }
  }
  std::erase_if(all, [](const SharedOption& shared) { return shared.commands.size() == 1; });
  return all;
}

bool is_shared(const CLI::Option* option, const std::vector<SharedOption>& all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const SharedOption& shared) { return are_same(shared.option, option); });
}

std::string markdown(std::string text) {
  return replaced(std::move(text), "|", "\\|");
}

/// Whether docs/options.md lists the option: it has the key of an option of a scene or an object.
bool is_listed_elsewhere(const CLI::Option* option) {
  static const std::vector<std::string> keys = keys_of_tables();
  std::string key = option->get_name(false, true).substr(2);
  std::ranges::replace(key, '-', '_');
  if (key.starts_with("no_")) key.erase(0, 3);
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// `--leaf-size 1`, with the default value of the description.
std::string with_default(const CLI::Option* option) {
  const std::string& text = option->get_description();
  const std::string_view mark = "default: ";
  const std::size_t at = text.rfind(mark);
  std::string name = replaced(option->get_name(false, true), ",", ", ");
  return at == std::string::npos
             ? name
             : name + " " + text.substr(at + mark.size(), text.rfind(')') - at - mark.size());
}

void print_markdown_options(const CLI::App& app, const std::vector<SharedOption>& shared) {
  std::string names, with_other_defaults;
  const auto append = [](std::string& list, const std::string& name) {
    list += fmt::format("{}`{}`", list.empty() ? "" : ", ", name);
  };
  fmt::print("| Option | Meaning |\n|---|---|\n");
  for (const CLI::Option* option : app.get_options()) {
    if (!is_documented(option)) continue;
    if (is_shared(option, shared))
      append(names, replaced(option->get_name(false, true), ",", ", "));
    else if (is_listed_elsewhere(option))
      append(with_other_defaults, with_default(option));
    else
      fmt::print("| `{}` | {} |\n", markdown(spelling(option)), option->get_description());
  }
  if (!with_other_defaults.empty())
    fmt::print("| [options](options.md#scene) of table1, with their defaults there | {} |\n",
               markdown(with_other_defaults));
  fmt::print("| [also](#options-of-several-commands) | {} |\n\n", names);
}

void print_shared_markdown_options(const std::vector<SharedOption>& all) {
  fmt::print(
      "\n## Options of several commands\n\nThe options of [scenes](options.md#scene) and "
      "[objects](options.md#object) are on their own page, with\ndefaults and ranges: `--leaf-size` is "
      "`leaf_size` there, and `--no-curves` sets `curves` to `false`. Those of\nobjects hold for all objects "
      "of a command. `--scene-octree-root` also takes `border`: the cube around the\nborder of the scene. "
      "The other options that several commands have:\n\n"
      "| Option | Meaning | Commands |\n|---|---|---|\n");
  for (const SharedOption& shared : all)
    if (!is_listed_elsewhere(shared.option))
      fmt::print("| `{}` | {} | {} |\n", markdown(spelling(shared.option)), shared.option->get_description(),
                 fmt::join(shared.commands, ", "));
}

/// The lines of examples of a footer, which is `Examples:` with indented lines, optionally followed by a
/// paragraph.
std::string examples_of(const std::string& footer) {
  const std::string examples = footer.substr(0, footer.find("\n\n"));
  return examples.substr(examples.find('\n') + 1);
}

std::string paragraph_of(const std::string& footer) {
  const std::size_t end_of_examples = footer.find("\n\n");
  return end_of_examples == std::string::npos ? "" : footer.substr(end_of_examples + 2);
}

/// An example is a command, indented by two blanks, and lines that explain it, indented by six.
void print_markdown_footer(const std::string& footer) {
  std::string rows;
  std::istringstream examples(examples_of(footer));
  for (std::string line; std::getline(examples, line);) {
    if (line.starts_with("      "))
      rows += " " + markdown(line.substr(6));
    else
      rows += fmt::format("{}| `{}` |", rows.empty() ? "" : " |\n", markdown(line.substr(2)));
  }
  fmt::print("| Example | What it does |\n|---|---|\n{} |\n", rows);
  const std::string paragraph = paragraph_of(footer);
  if (!paragraph.empty()) fmt::print("\n{}\n", paragraph);
}

void print_markdown(const CLI::App& program) {
  fmt::print(
      "# The command line\n\n`make docs` writes this page from the options of the program. `--help` and the "
      "manual page\nalso list the options of scenes and objects.\n\n{}\n\n",
      program.get_description());
  const std::string footer = program.get_footer();
  fmt::print("```text\n{}\n```\n\n{}\n", examples_of(footer), paragraph_of(footer));
  const std::vector<SharedOption> shared = shared_options(program);
  for (const CLI::App* command : commands_of(program)) {
    fmt::print("\n## supple {}\n\n{}: `supple {} {}`\n\n", command->get_name(), command->get_description(),
               command->get_name(), arguments_of(*command));
    print_markdown_options(*command, shared);
    print_markdown_footer(command->get_footer());
  }
  print_shared_markdown_options(shared);
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// Escapes text for roff: a leading dot or quote is not a request, and hyphens of options stay hyphens.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else
      escaped += c;
    line_start = c == '\n';
  }
  return escaped;
}

void print_roff_footer(const std::string& footer) {
  fmt::print(".nf\n{}\n.fi\n", roff(examples_of(footer)));
  const std::string paragraph = paragraph_of(footer);
  if (!paragraph.empty()) fmt::print(".PP\n{}\n", roff(paragraph));
}

void print_roff_option(const CLI::Option* option) {
  fmt::print(".TP\n.B {}\n{}\n", roff(spelling(option)), roff(option->get_description()));
}

void print_man(const CLI::App& program) {
  fmt::print(".TH SUPPLE 1 \"\" \"supple {}\" \"User Commands\"\n", SUPPLE_VERSION);
  fmt::print(
      ".SH NAME\nsupple \\- find every collision between deforming triangle meshes, exactly\n.SH SYNOPSIS\n");
  for (const CLI::App* command : commands_of(program))
    fmt::print(".B supple {}\n{}\n.br\n", command->get_name(), arguments_of(*command));
  fmt::print(
      ".SH DESCRIPTION\n{}\nMeshes are OBJ, OFF, PLY, STL, glTF, 3MF, Gmsh, VTK, TetGen or Medit files, or "
      "FBX, "
      "COLLADA and others that Assimp reads; scene files are TOML, recordings HDF5.\n",
      roff(program.get_description()));
  const std::vector<SharedOption> shared = shared_options(program);
  for (const CLI::App* command : commands_of(program)) {
    fmt::print(".SH SUPPLE {}\n{}.\n", upper_case(command->get_name()), roff(command->get_description()));
    std::string names;
    for (const CLI::Option* option : command->get_options()) {
      if (!is_documented(option)) continue;
      if (is_shared(option, shared))
        names += fmt::format("{}{}", names.empty() ? "" : ", ",
                             replaced(option->get_name(false, true), ",", ", "));
      else
        print_roff_option(option);
    }
    fmt::print(".PP\nAlso the options of several commands (below): {}\n", roff(names));
    fmt::print(".SS Examples\n");
    print_roff_footer(command->get_footer());
  }
  fmt::print(".SH OPTIONS OF SEVERAL COMMANDS\n");
  for (const SharedOption& each : shared) print_roff_option(each.option);
  fmt::print(
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\nSuccess.\n"
      ".TP\n.B 1\n\\-\\-fail\\-on\\-contact: something touches. diff: the recordings differ.\n"
      ".TP\n.B 2\nUsage or input error, reported in one line on standard error. simulate: the motion "
      "blew up. \\-\\-fail\\-on\\-contact: nothing touches, but something was not tested.\n"
      ".TP\n.B 3\n\\-\\-verify: brute force gives a different result. ccd\\-queries: an answer is false.\n"
      ".TP\n.B 130, 143\nA command was interrupted by SIGINT or SIGTERM; its files are whole and say that "
      "they "
      "are truncated.\n");
}

}  // namespace

void print_document(const CLI::App& program, const std::string& name) {
  if (name == "markdown") return print_markdown(program);
  if (name == "man") return print_man(program);
  if (name == "tables") return print_description_tables();
  if (name == "sections") return print_sections();
  if (name == "view-members") return print_view_members();
  throw CLI::ValidationError(
      "--generate", fmt::format("'{}' is not one of man, markdown, sections, tables, view-members", name));
}

}  // namespace supple::cli
