# cmake -DTEMPLATE= -DSTYLE= -DBASE_STYLE= -DSCRIPT= -DPACKAGES= -DSOURCE= -DTARGET= -P make_assets.cmake: the page's parts as C++ strings.
file(READ ${TEMPLATE} PAGE_TEMPLATE)
file(READ ${BASE_STYLE} PAGE_STYLE)
file(READ ${STYLE} style)
string(APPEND PAGE_STYLE "${style}")
file(READ ${SCRIPT} PAGE_SCRIPT)
# Their licences ask to be kept with every copy.
if(NOT PAGE_SCRIPT STREQUAL "")
  foreach(package three fflate)
    file(READ ${PACKAGES}/${package}/LICENSE licence)
    string(PREPEND PAGE_SCRIPT "/*!\n${package}\n\n${licence}*/\n")
  endforeach()
endif()
configure_file(${SOURCE} ${TARGET} @ONLY)
