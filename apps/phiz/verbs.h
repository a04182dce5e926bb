// SPDX-License-Identifier: GPL-3.0-or-later
/// The verbs of the command, one source file each. A verb adds its subcommand with options, help and a callback that
/// does the work; the callback throws phiz::Error, main.cpp turns errors into messages and exit codes.
#pragma once

namespace CLI {
class App;
}

namespace phiz {}  // namespace phiz
