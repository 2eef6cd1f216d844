# Writes a source file that holds the files of the page: page_files() of page_server.hpp.
# Arguments: folder, where page.cmake made the page, and target, the source file.
cmake_minimum_required(VERSION 3.25)

set(type_html text/html)
set(type_css text/css)
set(type_js text/javascript)
set(bytes "")
set(symbols "")
set(entries "")
set(number 0)
file(GLOB files ${folder}/*.html ${folder}/*.css ${folder}/*.js)
foreach(file IN LISTS files)
  cmake_path(GET file FILENAME name)
  cmake_path(GET file EXTENSION LAST_ONLY extension)
  string(SUBSTRING ${extension} 1 -1 extension)
  set(symbol nestgrid_page_${number})
  string(APPEND bytes ".hidden ${symbol}, ${symbol}_end\n.global ${symbol}, ${symbol}_end\n"
         "${symbol}:\n.incbin \"${file}\"\n${symbol}_end:\n")
  string(APPEND symbols "extern const char ${symbol}[];\nextern const char ${symbol}_end[];\n")
  string(APPEND entries "        {\"${name}\", \"${type_${extension}}; charset=utf-8\", "
         "bytes(${symbol}, ${symbol}_end)},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(
  WRITE ${target}
  "#include \"page_server.hpp\"

asm(R\"(
.section .rodata
${bytes}.previous
)\");
extern \"C\" {
${symbols}}

namespace nestgrid::view {

namespace {

std::string_view bytes(const char* begin, const char* end) {
    return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::vector<PageFile> page_files() {
    return {
${entries}    };
}

}  // namespace nestgrid::view
")
