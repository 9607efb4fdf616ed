"""The services of rosapi, by which clients ask what there is (facts of rosbridge_suite's rosapi_msgs)."""

from typing import Final

TYPE_DEF: Final = """
MSG: rosapi/TypeDef
string type
string[] fieldnames
string[] fieldtypes
int32[] fieldarraylen
string[] examples
string[] constnames
string[] constvalues
"""

SERVICES: Final[dict[str, str]] = {
    "rosapi/Topics": "---\nstring[] topics\nstring[] types\n",
    "rosapi/TopicsForType": "string type\n---\nstring[] topics\n",
    "rosapi/TopicsAndRawTypes": "---\nstring[] topics\nstring[] types\nstring[] typedefs_full_text\n",
    "rosapi/TopicType": "string topic\n---\nstring type\n",
    "rosapi/Publishers": "string topic\n---\nstring[] publishers\n",
    "rosapi/Subscribers": "string topic\n---\nstring[] subscribers\n",
    "rosapi/Services": "---\nstring[] services\n",
    "rosapi/ServicesForType": "string type\n---\nstring[] services\n",
    "rosapi/ServiceType": "string service\n---\nstring type\n",
    "rosapi/ServiceProviders": "string service\n---\nstring[] providers\n",
    "rosapi/ServiceNode": "string service\n---\nstring node\n",
    "rosapi/ServiceHost": "string service\n---\nstring host\n",
    "rosapi/ActionType": "string action\n---\nstring type\n",
    "rosapi/ActionGoalDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/ActionResultDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/ActionFeedbackDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/Interfaces": "---\nstring[] interfaces\n",
    "rosapi/SearchParam": "string name\n---\nstring global_name\n",
    "rosapi/GetActionServers": "---\nstring[] action_servers\n",
    "rosapi/Nodes": "---\nstring[] nodes\n",
    "rosapi/NodeDetails": "string node\n---\nstring[] subscribing\nstring[] publishing\nstring[] services\n",
    "rosapi/MessageDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/ServiceRequestDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/ServiceResponseDetails": "string type\n---\nTypeDef[] typedefs\n",
    "rosapi/GetParam": "string name\nstring default_value\nstring default\n---\nstring value\n",
    "rosapi/SetParam": "string name\nstring value\n---\n",
    "rosapi/HasParam": "string name\n---\nbool exists\n",
    "rosapi/DeleteParam": "string name\n---\n",
    "rosapi/GetParamNames": "---\nstring[] names\n",
    "rosapi/GetTime": "---\ntime time\n",
    "rosapi/GetROSVersion": "---\nuint8 version\nstring distro\n",
}
