# cmake -DTEMPLATE= -DSTYLE= -DBASE_STYLE= -DSCRIPT= -DSOURCE= -DTARGET= -P make_assets.cmake: the page's parts as C++ strings.
file(READ ${TEMPLATE} PAGE_TEMPLATE)
file(READ ${BASE_STYLE} PAGE_STYLE)
file(READ ${STYLE} style)
string(APPEND PAGE_STYLE "${style}")
file(READ ${SCRIPT} PAGE_SCRIPT)
configure_file(${SOURCE} ${TARGET} @ONLY)
