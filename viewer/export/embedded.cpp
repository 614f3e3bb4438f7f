#include "embedded.hpp"

namespace supple::viewer {
namespace {

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace
}  // namespace supple::viewer

#ifdef SUPPLE_VIEWER_PAGE

#ifdef __APPLE__
#define SUPPLE_READ_ONLY ".section __TEXT,__const\n"
#define SUPPLE_TEXT_AGAIN ".text\n"
#define SUPPLE_SYMBOL(name) "_" name
#else
#define SUPPLE_READ_ONLY ".pushsection .rodata, \"a\", %progbits\n"
#define SUPPLE_TEXT_AGAIN ".popsection\n"
#define SUPPLE_SYMBOL(name) name
#endif

// The assembler includes a file of megabytes at once; compiling an array of numbers would take minutes.
#define SUPPLE_EMBED(name, file)                                                     \
  asm(SUPPLE_READ_ONLY ".balign 16\n.globl " SUPPLE_SYMBOL(name) "\n" SUPPLE_SYMBOL( \
      name) ":\n.incbin \"" file                                                     \
            "\"\n.globl " SUPPLE_SYMBOL(name) "_end\n" SUPPLE_SYMBOL(                \
                name) "_end:\n.byte 0\n" SUPPLE_TEXT_AGAIN)

SUPPLE_EMBED("supple_viewer_page", SUPPLE_VIEWER_PAGE);
SUPPLE_EMBED("supple_viewer_module", SUPPLE_VIEWER_MODULE);

extern "C" {
extern const std::byte supple_viewer_page[], supple_viewer_page_end[];
extern const std::byte supple_viewer_module[], supple_viewer_module_end[];
}

namespace supple::viewer {

std::string_view embedded_page() {
  return text_of({supple_viewer_page, supple_viewer_page_end});
}

std::span<const std::byte> embedded_module() {
  return {supple_viewer_module, supple_viewer_module_end};
}

}  // namespace supple::viewer

#else

namespace supple::viewer {

std::string_view embedded_page() {
  return text_of({});
}

std::span<const std::byte> embedded_module() {
  return {};
}

}  // namespace supple::viewer

#endif
