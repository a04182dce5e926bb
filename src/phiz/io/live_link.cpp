// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/live_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "phiz/anatomy/expression_names.h"
#include "phiz/core/error.h"
#include "phiz/io/csv_reader.h"
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
constexpr int angle_count = static_cast<int>(angle_names.size());
constexpr int value_count = expression_count + angle_count;
constexpr int unknown_column = -1, count_column = -2, timecode_column = -3, seconds_column = -4,
              milliseconds_column = -5;

/// Lower case without separators, brackets and what stands before a dot, colon or slash.
std::string plain_name(std::string_view name) {
  const std::size_t prefix = name.find_last_of(".:/|");
  if (prefix != std::string_view::npos) name.remove_prefix(prefix + 1);
  std::string plain = lowered(name);
  std::erase_if(plain, [](char c) { return std::string_view("_- ()[]").find(c) != std::string_view::npos; });
  return plain;
}

/// Column number per plain name: 0 to 51 expressions, 52 to 60 angles.
std::map<std::string, int> known_columns() {
  std::map<std::string, int> columns = {{"timecode", timecode_column}, {"blendshapecount", count_column}};
  for (const std::string time : {"time", "timestamp", ""}) {
    for (const char* unit : {"", "s", "sec", "seconds"}) columns[time + unit] = seconds_column;
    for (const char* unit : {"ms", "msec", "milliseconds"}) columns[time + unit] = milliseconds_column;
  }
  columns.erase("");
  columns.erase("s");
  for (int i = 0; i < expression_count; ++i) {
    const std::string name = plain_name(expression_names[static_cast<std::size_t>(i)]);
    columns[name] = i;
    if (name.ends_with("left")) columns[name.substr(0, name.size() - 3)] = i;
    if (name.ends_with("right")) columns[name.substr(0, name.size() - 4)] = i;
  }
  for (int i = 0; i < angle_count; ++i)
    columns[plain_name(angle_names[static_cast<std::size_t>(i)])] = expression_count + i;
  return columns;
}

std::string with_decimal_point(std::string field) {
  std::replace(field.begin(), field.end(), ',', '.');
  return field;
}

bool is_time(int column) {
  return column == timecode_column || column == seconds_column || column == milliseconds_column;
}

class RecordingParser {
 public:
  RecordingParser(std::string_view text, const std::string& where) : where_(where), rows_(text, where) {}

  LiveLinkRecording parse() {
    match_columns();
    read_rows();
    note_unusual_weights();
    check_time();
    set_frame_rate();
    drop_repeated_frames();
    return std::move(result_);
  }

 private:
  std::string place(int line) const { return fmt::format("{}:{}", where_, line); }
  void note(std::string text) { result_.notes.push_back(std::move(text)); }

  void match_columns() {
    const auto known = known_columns();
    const std::vector<std::string>& header = rows_.header();
    std::array<bool, value_count> found{};
    std::string unknown, missing;
    for (std::size_t c = 0; c < header.size(); ++c) {
      const auto place = known.find(plain_name(header[c]));
      target_.push_back(place == known.end() ? unknown_column : place->second);
      if (is_time(target_[c])) {
        // A time code before seconds before milliseconds.
        if (!time_column_ || target_[c] > target_[*time_column_]) time_column_ = c;
      } else if (target_[c] == count_column) {
        count_column_ = c;
      } else if (target_[c] == unknown_column) {
        if (!header[c].empty()) unknown += (unknown.empty() ? "" : ", ") + quoted_word(header[c]);
      } else {
        bool& seen = found[static_cast<std::size_t>(target_[c])];
        if (seen) reject(rows_.header_place(), fmt::format("column {} appears twice", quoted_word(header[c])));
        seen = true;
      }
    }
    if (std::none_of(found.begin(), found.begin() + expression_count, [](bool f) { return f; })) {
      reject(rows_.header_place(), "no column is named like an expression (jawOpen, mouthSmileLeft, ...)",
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

  /// Recorders write a row without values, sometimes a short one, while they see no face.
  bool row_has_no_face() const {
    const std::vector<std::string>& fields = rows_.fields();
    for (std::size_t c = 0; c < std::min(fields.size(), target_.size()); ++c)
      if (target_[c] >= 0 && !fields[c].empty()) return false;
    if (fields.size() == target_.size()) return true;
    return count_column_ && *count_column_ < fields.size() && parse_number(fields[*count_column_]) == 0.0;
  }

  void read_rows() {
    std::vector<double> values;
    int without_face = 0;
    while (rows_.next()) {
      if (row_has_no_face()) {
        ++without_face;
        continue;
      }
      rows_.require_full_row();
      values.resize(values.size() + value_count, 0.0);
      double* const row = values.data() + values.size() - value_count;
      for (std::size_t c = 0; c < target_.size(); ++c)
        if (target_[c] >= 0) row[target_[c]] = checked(number(c), c);
      read_time();
      line_.push_back(rows_.line());
    }
    if (line_.empty())
      reject(where_, without_face > 0 ? "no face was seen in any frame" : "a header but no frames",
             "the recording is empty");
    if (without_face > 0) note(fmt::format("{} frames in which no face was seen are left out", without_face));
    store(values);
    finish_time();
  }

  double number(std::size_t column) const {
    const auto value = parse_number(with_decimal_point(rows_.fields()[column]));
    if (!value || !std::isfinite(*value)) {
      reject(place(rows_.line()),
             fmt::format("column {}: expected a finite number, found {}", quoted_word(rows_.header()[column]),
                         quoted_word(rows_.fields()[column])),
             "correct the number or delete the line");
    }
    return *value;
  }

  /// The value of an expression or an angle, which must be in the range of its unit.
  double checked(double value, std::size_t column) const {
    const bool weight = target_[column] < expression_count;
    if (std::abs(value) <= (weight ? largest_weight : largest_angle)) return value;
    const std::string name = quoted_word(rows_.header()[column]);
    if (weight) {
      reject(place(rows_.line()), fmt::format("column {}: weight {} is far outside of 0 to 1", name, value),
             "if the weights are percentages, divide them by 100");
    }
    reject(place(rows_.line()), fmt::format("column {}: angle {} is more than half a turn in radians", name, value),
           "if the angles are degrees, multiply them by 0.0174533");
  }

  /// `values`: value_count numbers per frame.
  void store(const std::vector<double>& values) {
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, value_count, Eigen::RowMajor>> rows(
        values.data(), static_cast<Eigen::Index>(line_.size()), value_count);
    const Eigen::RowVector3d signs(angle_signs[0], angle_signs[1], angle_signs[2]);
    Performance& p = result_.performance;
    p.expressions.assign(expression_names.begin(), expression_names.end());
    p.weights = rows.leftCols<expression_count>();
    int first = expression_count;
    for (MatrixX3d* angles : {&p.head, &p.left_eye, &p.right_eye}) {
      *angles = rows.middleCols<3>(first).array().rowwise() * signs.array();
      first += 3;
    }
  }

  /// Of the row, into `codes_` or `time_`, whichever the first row asks for.
  void read_time() {
    if (!time_column_) return;
    const std::string field = with_decimal_point(rows_.fields()[*time_column_]);
    const auto code = parse_timecode(field);
    const auto clock = parse_clock(field);
    const bool first = line_.empty();
    if (first && (code || clock)) is_clock_ = clock.has_value();
    if (first ? code || clock : !codes_.empty()) {
      const auto& found = is_clock_ ? clock : code;
      if (!found)
        reject(place(rows_.line()), "expected a time code HH:MM:SS:FF.sub as before, found " + quoted_word(field));
      codes_.push_back(*found);
      return;
    }
    if (target_[*time_column_] == timecode_column && !parse_number(field))
      reject(place(rows_.line()), "expected a time code HH:MM:SS:FF.sub, found " + quoted_word(field));
    const double unit = target_[*time_column_] == milliseconds_column ? 1e-3 : 1;
    time_.push_back(number(*time_column_) * unit);
  }

  /// Seconds since the first frame.
  void finish_time() {
    if (!time_column_) {
      note(fmt::format("there is no time column; frames count as 1/{} s apart", default_rate));
      for (std::size_t i = 0; i < line_.size(); ++i) time_.push_back(static_cast<double>(i) / default_rate);
    } else if (!codes_.empty()) {
      time_ = timecode_seconds(codes_, is_clock_ ? 1 : timecode_rate(codes_));
    }
    for (std::size_t i = time_.size(); i-- > 0;) time_[i] -= time_[0];
    result_.performance.time = Eigen::Map<const VectorXd>(time_.data(), static_cast<Eigen::Index>(time_.size()));
  }

  void note_unusual_weights() {
    const MatrixXd& weights = result_.performance.weights;
    const double low = weights.minCoeff(), high = weights.maxCoeff();
    if (low < -unusual_excess || high > 1 + unusual_excess)
      note(fmt::format("weights go from {:.3g} to {:.3g}; they are played as they are", low, high));
  }

  void check_time() const {
    for (std::size_t i = 1; i < time_.size(); ++i) {
      if (time_[i] < time_[i - 1]) {
        reject(place(line_[i]), fmt::format("time runs backward by {:.4g} s", time_[i - 1] - time_[i]),
               "sort the frames by time");
      }
      if (time_[i] > 7 * 86400.0)
        reject(place(line_[i]), "the recording is longer than a week", "is the time in seconds?");
    }
  }

  /// The rate is that of the typical step, a usual rate where it is near one.
  void set_frame_rate() {
    std::vector<double> steps;
    for (std::size_t i = 1; i < time_.size(); ++i) {
      if (time_[i] > time_[i - 1]) steps.push_back(time_[i] - time_[i - 1]);
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
  CsvReader rows_;
  std::vector<int> target_;  // per column: its expression or angle, or one of the negative constants
  std::optional<std::size_t> time_column_, count_column_;
  std::vector<int> line_;        // per frame
  std::vector<double> time_;     // per frame, when the file has seconds
  std::vector<Timecode> codes_;  // per frame, when the file has time codes
  bool is_clock_ = false;        // they are HH:MM:SS.sss
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
    text += format_timecode(performance.time[frame], rate) + fmt::format(",{}", value_count);
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
