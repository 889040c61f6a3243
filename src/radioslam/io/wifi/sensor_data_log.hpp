// Reads logs of the GetSensorData app for Android (LOPSI group, CSIC; the format of the IPIN competitions):
// one record per line, fields separated by semicolons, `%` comments.
//
//   ACCE;app_s;sensor_s;x;y;z;accuracy            m/s^2
//   GYRO;app_s;sensor_s;x;y;z;accuracy            rad/s
//   AHRS;app_s;sensor_s;pitch;roll;yaw;qx;qy;qz;accuracy     vector part of the quaternion, device to
//                                                            east-north-up
//   WIFI;app_s;sensor_s;ssid;bssid[;frequency];rssi_dbm
//
// Times are seconds of the app's clock, at which it received the record. Samples have also the sensor's time;
// it is used, plus the median delay of its sensor, because the app receives samples in batches. Records of
// other types are skipped. Other lines cost the records in them; the names of networks may contain any bytes
// but line ends.
#pragma once

#include "radioslam/io/wifi/phone_log.hpp"

namespace radioslam {

/// Whether a text begins as such a log does.
bool is_sensor_data_log(const Text& text);

/// The log may lack any of the sensors. Refuses (InputError) a log of which most records are malformed, and
/// one without records or of a single time.
PhoneLog read_sensor_data_log(const Text& text);

}  // namespace radioslam
