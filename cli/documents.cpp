#include "documents.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "description_tables.hpp"
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

void print_markdown_options(const CLI::App& app) {
  fmt::print("| Option | Meaning |\n|---|---|\n");
  for (const CLI::Option* option : app.get_options()) {
    if (!is_documented(option)) continue;
    fmt::print("| `{}` | {} |\n", replaced(spelling(option), "|", "\\|"), option->get_description());
  }
  fmt::print("\n");
}

/// The footer is `Examples:` with indented lines, optionally followed by a paragraph.
void print_markdown_footer(const std::string& footer) {
  const std::size_t end_of_examples = footer.find("\n\n");
  const std::string_view examples = std::string_view(footer).substr(0, end_of_examples);
  fmt::print("```text\n{}\n```\n", examples.substr(examples.find('\n') + 1));
  if (end_of_examples != std::string::npos) fmt::print("\n{}\n", footer.substr(end_of_examples + 2));
}

void print_markdown(const CLI::App& program) {
  fmt::print(
      "# The command line\n\n`make docs` writes this page from the options of the program. `--help` and the "
      "manual page have\nthe same content.\n\n{}\n\n",
      program.get_description());
  print_markdown_footer(program.get_footer());
  for (const CLI::App* command : commands_of(program)) {
    fmt::print("\n## supple {}\n\n{}.\n\n`supple {} {}`\n\n", command->get_name(), command->get_description(),
               command->get_name(), arguments_of(*command));
    print_markdown_options(*command);
    print_markdown_footer(command->get_footer());
  }
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
  const std::size_t end_of_examples = footer.find("\n\n");
  const std::string examples = footer.substr(0, end_of_examples);
  fmt::print(".nf\n{}\n.fi\n", roff(examples.substr(examples.find('\n') + 1)));
  if (end_of_examples != std::string::npos) fmt::print(".PP\n{}\n", roff(footer.substr(end_of_examples + 2)));
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
  for (const CLI::App* command : commands_of(program)) {
    fmt::print(".SH SUPPLE {}\n{}.\n", upper_case(command->get_name()), roff(command->get_description()));
    for (const CLI::Option* option : command->get_options()) {
      if (is_documented(option))
        fmt::print(".TP\n.B {}\n{}\n", roff(spelling(option)), roff(option->get_description()));
    }
    fmt::print(".SS Examples\n");
    print_roff_footer(command->get_footer());
  }
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
  throw CLI::ValidationError("--generate", fmt::format("'{}' is not one of man, markdown, tables", name));
}

}  // namespace supple::cli
