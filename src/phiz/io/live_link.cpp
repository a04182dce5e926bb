// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/live_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "phiz/anatomy/expression_names.h"
#include "phiz/core/error.h"
#include "phiz/io/csv_table.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/text_scanner.h"
#include "phiz/io/timecode.h"

namespace phiz {

namespace {

constexpr double default_rate = 60;
constexpr double slowest_rate = 1, fastest_rate = 1000;  // frames per second of a recording that can be meant
constexpr double largest_weight = 3;     // recorders overshoot 1 a little; percentages exceed this at once
constexpr double unusual_excess = 0.05;  // beyond 0 to 1, that the user hears of
constexpr double largest_angle = 3.3;    // radians, a little more than half a turn

/// The nine angles after the expressions, in the order of the app: column of the 9-vector (head, left eye, right eye)
/// and the factor that turns the recorder's sign into ours.
constexpr std::array<std::string_view, 9> angle_names = {"headYaw",     "headPitch",     "headRoll",
                                                         "leftEyeYaw",  "leftEyePitch",  "leftEyeRoll",
                                                         "rightEyeYaw", "rightEyePitch", "rightEyeRoll"};
constexpr std::array<double, 3> angle_signs = {-1, 1, -1};

constexpr int expression_count = static_cast<int>(expression_names.size());
constexpr int unknown_column = -1, count_column = -2, timecode_column = -3, seconds_column = -4;

/// Lower case without separators and without what stands before a dot, colon or slash.
std::string plain_name(std::string_view name) {
  const std::size_t prefix = name.find_last_of(".:/|");
  if (prefix != std::string_view::npos) name.remove_prefix(prefix + 1);
  std::string plain = lowered(name);
  std::erase_if(plain, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return plain;
}

/// Column number per plain name: 0 to 51 expressions, 52 to 60 angles.
std::map<std::string, int> known_columns() {
  std::map<std::string, int> columns = {{"timecode", timecode_column}, {"blendshapecount", count_column},
                                        {"time", seconds_column},      {"seconds", seconds_column},
                                        {"timestamp", seconds_column}, {"times", seconds_column}};
  for (int i = 0; i < expression_count; ++i) {
    const std::string name = plain_name(expression_names[static_cast<std::size_t>(i)]);
    columns[name] = i;
    if (name.ends_with("left")) columns[name.substr(0, name.size() - 3)] = i;
    if (name.ends_with("right")) columns[name.substr(0, name.size() - 4)] = i;
  }
  for (int i = 0; i < 9; ++i) columns[plain_name(angle_names[static_cast<std::size_t>(i)])] = expression_count + i;
  return columns;
}

class RecordingParser {
 public:
  RecordingParser(std::string_view text, const std::string& where) : where_(where), table_(parse_csv(text, where)) {}

  LiveLinkRecording parse() {
    match_columns();
    if (table_.rows.empty()) reject(where_, "a header but no frames", "the recording is empty");
    read_values();
    note_unusual_weights();
    read_time();
    drop_repeated_frames();
    return std::move(result_);
  }

 private:
  std::string here(std::size_t row) const { return fmt::format("{}:{}", where_, table_.lines[row]); }
  void note(std::string text) { result_.notes.push_back(std::move(text)); }

  void match_columns() {
    const auto known = known_columns();
    std::array<bool, expression_count + 9> found{};
    std::string unknown, missing;
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      const auto place = known.find(plain_name(table_.header[c]));
      target_.push_back(place == known.end() ? unknown_column : place->second);
      if (target_[c] == timecode_column || target_[c] == seconds_column) {
        if (time_column_ >= 0 && target_[static_cast<std::size_t>(time_column_)] == timecode_column) continue;
        time_column_ = static_cast<int>(c);
      } else if (target_[c] == unknown_column) {
        if (!table_.header[c].empty()) unknown += (unknown.empty() ? "" : ", ") + quoted_word(table_.header[c]);
      } else if (target_[c] >= 0) {
        bool& seen = found[static_cast<std::size_t>(target_[c])];
        if (seen) reject(where_ + ":1", fmt::format("column {} appears twice", quoted_word(table_.header[c])));
        seen = true;
      }
    }
    if (std::none_of(found.begin(), found.begin() + expression_count, [](bool f) { return f; })) {
      reject(where_ + ":1", "no column is named like an expression (jawOpen, mouthSmileLeft, ...)",
             "is it a Live Link Face recording?");
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i]) continue;
      missing += missing.empty() ? "" : ", ";
      missing += i < expression_names.size() ? expression_names[i] : angle_names[i - expression_names.size()];
    }
    if (!missing.empty()) note("columns that are missing count as zero: " + missing);
    if (!unknown.empty()) note("columns that are not known are left out: " + unknown);
  }

  double number(std::size_t row, std::size_t column) const {
    std::string field = table_.rows[row][column];
    if (table_.separator != ',') std::replace(field.begin(), field.end(), ',', '.');
    const auto value = parse_number(field);
    if (!value || !std::isfinite(*value)) {
      reject(here(row), fmt::format("column {}: expected a finite number, found {}", quoted_word(table_.header[column]),
                                    quoted_word(table_.rows[row][column])));
    }
    return *value;
  }

  void read_values() {
    Performance& p = result_.performance;
    p.expressions.assign(expression_names.begin(), expression_names.end());
    const auto frames = static_cast<Eigen::Index>(table_.rows.size());
    p.weights = MatrixXd::Zero(frames, expression_count);
    for (MatrixX3d* angles : {&p.head, &p.left_eye, &p.right_eye}) *angles = MatrixX3d::Zero(frames, 3);
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      for (std::size_t c = 0; c < target_.size(); ++c) {
        if (target_[c] >= 0) store(row, c, number(row, c));
      }
    }
  }

  void store(std::size_t row, std::size_t column, double value) {
    Performance& p = result_.performance;
    const auto frame = static_cast<Eigen::Index>(row);
    const int target = target_[column];
    const std::string name = quoted_word(table_.header[column]);
    if (target < expression_count) {
      if (std::abs(value) > largest_weight) {
        reject(here(row), fmt::format("column {}: weight {} is far outside of 0 to 1", name, value),
               "if the weights are percentages, divide them by 100");
      }
      p.weights(frame, target) = value;
      return;
    }
    if (std::abs(value) > largest_angle) {
      reject(here(row), fmt::format("column {}: angle {} is more than half a turn in radians", name, value),
             "if the angles are degrees, multiply them by 0.0174533");
    }
    const int angle = target - expression_count;
    MatrixX3d& angles = angle < 3 ? p.head : angle < 6 ? p.left_eye : p.right_eye;
    angles(frame, angle % 3) = value * angle_signs[static_cast<std::size_t>(angle % 3)];
  }

  void note_unusual_weights() {
    const MatrixXd& weights = result_.performance.weights;
    const double low = weights.minCoeff(), high = weights.maxCoeff();
    if (low < -unusual_excess || high > 1 + unusual_excess)
      note(fmt::format("weights go from {:.3g} to {:.3g}; they are played as they are", low, high));
  }

  void read_time() {
    const std::size_t rows = table_.rows.size();
    std::vector<double> time(rows);
    const auto column = static_cast<std::size_t>(std::max(time_column_, 0));
    double rate = 0;
    if (time_column_ < 0) {
      note(fmt::format("there is no time column; frames count as 1/{} s apart", default_rate));
      for (std::size_t i = 0; i < rows; ++i) time[i] = static_cast<double>(i) / default_rate;
    } else if (parse_timecode(table_.rows[0][column])) {
      std::vector<Timecode> codes;
      for (std::size_t i = 0; i < rows; ++i) {
        const auto code = parse_timecode(table_.rows[i][column]);
        if (!code)
          reject(here(i), "expected a time code HH:MM:SS:FF.sub, found " + quoted_word(table_.rows[i][column]));
        codes.push_back(*code);
      }
      rate = timecode_rate(codes);
      time = timecode_seconds(codes, rate);
    } else {
      if (target_[column] == timecode_column && !parse_number(table_.rows[0][column])) {
        reject(here(0), "expected a time code HH:MM:SS:FF.sub, found " + quoted_word(table_.rows[0][column]));
      }
      for (std::size_t i = 0; i < rows; ++i) time[i] = number(i, column);
      for (std::size_t i = rows; i-- > 0;) time[i] -= time[0];
    }
    for (std::size_t i = 1; i < rows; ++i) {
      if (time[i] < time[i - 1]) {
        reject(here(i), fmt::format("time runs backward by {:.4g} s", time[i - 1] - time[i]),
               "sort the frames by time");
      }
      if (time[i] > 7 * 86400.0) reject(here(i), "the recording is longer than a week", "is the time in seconds?");
    }
    result_.performance.time = Eigen::Map<const VectorXd>(time.data(), static_cast<Eigen::Index>(rows));
    set_frame_rate(time);
  }

  /// The rate is that of the typical step, a usual rate where it is near one.
  void set_frame_rate(const std::vector<double>& time) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < time.size(); ++i) {
      if (time[i] > time[i - 1]) steps.push_back(time[i] - time[i - 1]);
    }
    double& rate = result_.performance.frame_rate;
    rate = default_rate;
    if (steps.empty()) return;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double step = *middle;
    rate = 1 / step;
    if (rate < slowest_rate || rate > fastest_rate) {
      reject(where_, fmt::format("the typical step between frames is {:.4g} s", step),
             "time codes or seconds are expected; divide milliseconds by 1000");
    }
    for (const double usual : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0}) {
      if (std::abs(rate / usual - 1) < 0.03) rate = usual;
    }
    const auto gaps = std::count_if(steps.begin(), steps.end(), [step](double s) { return s > 1.5 * step; });
    if (gaps > 0) note(fmt::format("the recording has {} gaps where frames were dropped", gaps));
  }

  void drop_repeated_frames() {
    Performance& p = result_.performance;
    std::vector<Eigen::Index> kept = {0};
    for (Eigen::Index i = 1; i < p.time.size(); ++i) {
      if (p.time[i] > p.time[kept.back()]) kept.push_back(i);
    }
    const auto repeated = p.time.size() - static_cast<Eigen::Index>(kept.size());
    if (repeated == 0) return;
    note(fmt::format("{} frames that repeat the time of the one before are left out", repeated));
    p.time = VectorXd(p.time(kept));
    p.weights = MatrixXd(p.weights(kept, Eigen::all));
    p.head = MatrixX3d(p.head(kept, Eigen::all));
    p.left_eye = MatrixX3d(p.left_eye(kept, Eigen::all));
    p.right_eye = MatrixX3d(p.right_eye(kept, Eigen::all));
  }

  std::string where_;
  CsvTable table_;
  std::vector<int> target_;
  int time_column_ = -1;
  LiveLinkRecording result_;
};

std::string upper_first(std::string_view name) {
  std::string result(name);
  if (result[0] >= 'a' && result[0] <= 'z') result[0] = static_cast<char>(result[0] - 'a' + 'A');
  return result;
}

}  // namespace

LiveLinkRecording parse_live_link(std::string_view text, const std::string& where) {
  return RecordingParser(text, where).parse();
}

LiveLinkRecording read_live_link(const std::string& path) {
  return parse_live_link(read_bytes(path), path);
}

void write_live_link(const std::string& path, const Performance& performance) {
  std::string text = "Timecode,BlendShapeCount";
  std::vector<Eigen::Index> source;
  for (const std::string_view name : expression_names) {
    text += "," + upper_first(name);
    const auto place = std::find(performance.expressions.begin(), performance.expressions.end(), name);
    source.push_back(place == performance.expressions.end() ? -1 : place - performance.expressions.begin());
  }
  for (const std::string_view name : angle_names) text += "," + upper_first(name);
  text += "\n";
  const double nominal = std::round(performance.frame_rate);
  const int rate = nominal >= 24 && nominal <= 120 ? static_cast<int>(nominal) : 60;
  for (Eigen::Index frame = 0; frame < performance.time.size(); ++frame) {
    text += format_timecode(performance.time[frame], rate) + fmt::format(",{}", expression_count + 9);
    for (const Eigen::Index column : source) {
      text += fmt::format(",{:.9g}", column < 0 ? 0.0 : performance.weights(frame, column));
    }
    for (const MatrixX3d* angles : {&performance.head, &performance.left_eye, &performance.right_eye}) {
      for (int k = 0; k < 3; ++k) {
        const double angle = frame < angles->rows() ? (*angles)(frame, k) : 0;
        text += fmt::format(",{:.9g}", angle * angle_signs[static_cast<std::size_t>(k)] + 0.0);
      }
    }
    text += "\n";
  }
  write_bytes(path, text);
}

}  // namespace phiz
