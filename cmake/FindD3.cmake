# Finds d3 version 5 (a JavaScript file that is embedded in every report) and defines D3_JS.
# -DD3_JS=/path/to/d3.min.js selects another copy.
find_file(D3_JS d3.min.js
  PATHS /usr/share/nodejs/d3/dist /usr/share/javascript/d3 /usr/local/share/nodejs/d3/dist
  NO_DEFAULT_PATH DOC "d3.min.js, version 5")
set(D3_VERSION D3_VERSION-NOTFOUND)
if(D3_JS AND EXISTS "${D3_JS}")
  file(READ "${D3_JS}" d3_banner LIMIT 200)
  if(d3_banner MATCHES "d3js.org v([0-9.]+)")
    set(D3_VERSION ${CMAKE_MATCH_1})
  endif()
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(D3 REQUIRED_VARS D3_JS D3_VERSION VERSION_VAR D3_VERSION HANDLE_VERSION_RANGE
  REASON_FAILURE_MESSAGE "the report's page needs d3 version 5: 'apt install node-d3', or name a copy with -DD3_JS=/path/to/d3.min.js")
mark_as_advanced(D3_JS)
