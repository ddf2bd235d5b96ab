behavior_name=goto_list
<start:b_arg>
b_arg: list_stop_when([31m) 7
<end:b_arg>
<start:waypoints>
[31m 3117.5
-118.5 33.4
<end:waypoints>
