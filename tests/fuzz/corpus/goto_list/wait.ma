behavior_name=goto_list
# Written by Glidehelm on UTC: 2026-05-03T04:10:25Z
# plan: alba-1
# method: direct

<start:b_arg>
	b_arg: num_legs_to_run(nodim) -2
	b_arg: start_when(enum) 0
	b_arg: list_stop_when(enum) 7
	b_arg: list_when_wpt_dist(m) 700.0
	b_arg: initial_wpt(enum) 0
	b_arg: num_waypoints(nodim) 2
	b_arg: end_action(enum) 6
<end:b_arg>
<start:waypoints>
-1530.0000	2910.5000
-30.5000	5.0001
<end:waypoints>
