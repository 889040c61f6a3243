# Script: inserts the parts of a page into its HTML and writes the result as C++.
#   cmake -DPAGE=page.html -DSTYLE=a.css -DSCRIPTS=a.js|b.js -DD3=d3.min.js -DLICENCE=d3-licence.txt
#         -DHEADER=radioslam/room/page_parts.hpp -DNAMESPACE=radioslam -DOUTPUT=page.cpp -P EmbedPage.cmake
# The HTML refers to its parts as @style@, @d3@, @licence@ and @script@; it is split at @data@.
# Bytes are written as numbers, so that no part can terminate the literal that contains it.
file(READ "${PAGE}" page)
file(READ "${STYLE}" style)
file(READ "${D3}" d3)
file(READ "${LICENCE}" licence)
set(script "")
string(REPLACE "|" ";" SCRIPTS "${SCRIPTS}")
foreach(file IN LISTS SCRIPTS)
  file(READ "${file}" part)
  string(APPEND script "${part}\n")
endforeach()

foreach(part IN ITEMS style script d3 licence)
  string(FIND "${${part}}" "</script" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${part} contains '</script', which would end the element that contains it")
  endif()
  string(REPLACE "@${part}@" "${${part}}" page "${page}")
endforeach()

string(FIND "${page}" "@data@" cut)
string(LENGTH "@data@" mark)
math(EXPR rest "${cut} + ${mark}")
string(SUBSTRING "${page}" 0 ${cut} head)
string(SUBSTRING "${page}" ${rest} -1 tail)

function(write_bytes name text)
  string(HEX "${text}" bytes)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(REGEX REPLACE "(................................................................................................................)" "\\1\n" bytes "${bytes}")
  file(APPEND "${OUTPUT}" "constexpr char ${name}_bytes[] = {\n${bytes}};\n")
endfunction()

file(WRITE "${OUTPUT}" "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\nnamespace {\n")
write_bytes(head "${head}")
write_bytes(tail "${tail}")
file(APPEND "${OUTPUT}" "}  // namespace\n\nstd::string_view page_head() { return {head_bytes, sizeof head_bytes}; }\n")
file(APPEND "${OUTPUT}" "std::string_view page_tail() { return {tail_bytes, sizeof tail_bytes}; }\n\n}  // namespace ${NAMESPACE}\n")
