behavior_name=goto_list
# Glidehelm 2026-11-25T10:20:30Z plan 7
<start:b_arg>
  b_arg: num_legs_to_run(nodim) -2
  b_arg: start_when(enum) 0 # BAW_IMMEDIATELY
  b_arg: list_stop_when(enum) 7
  b_arg: list_when_wpt_dist(m) 432.1
  b_arg: initial_wpt(enum) 0
  b_arg: num_waypoints(nodim) 2
  b_arg: end_action(enum) 6
<end:b_arg>
<start:waypoints>
-11731.8200 3250.6200
17959.9999	-0030.5000
<end:waypoints>
