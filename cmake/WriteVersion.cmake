# SPDX-License-Identifier: GPL-3.0-or-later
# Script run at every build: writes OUTPUT from INPUT with VERSION and the commit of SOURCE_DIR. The file is touched only
# when its text changes.
execute_process(COMMAND git describe --always --dirty=+ --abbrev=10 --exclude=* WORKING_DIRECTORY "${SOURCE_DIR}"
                OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
configure_file("${INPUT}" "${OUTPUT}" @ONLY)
